// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// spidartrack record with more than one film, process, or way to be called.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <sys/stat.h>
#include <thread>
#include <utility>
#include <vector>

#include <gst/gst.h>
#include <gtest/gtest.h>

#include "plugin/tools/track_samples.h"
#include "plugin/track/part_file.h"
#include "tests/pipelines/track_command.h"
#include "tests/support/child_process.h"
#include "tests/support/temporary_folder.h"

namespace spidar::test::track_batch_test {
namespace {

namespace fs = std::filesystem;

class TrackBatch : public testing::Test {
 protected:
  static void SetUpTestSuite() { gst_init(nullptr, nullptr); }
  /// 25 frames a second.
  void make_film(const std::string& name, int frames = 25) const {
    fs::create_directories(fs::path(path(name)).parent_path());
    run_pipeline("videotestsrc num-buffers=" + std::to_string(frames) +
                 " pattern=ball ! video/x-raw,width=160,height=120,framerate=25/1 ! jpegenc ! "
                 "avimux ! filesink location=" +
                 quoted(path("made.film")));
    fs::rename(path("made.film"), path(name));
  }
  std::string path(const std::string& name) const { return (folder.path / name).string(); }
  /// Runs it in the folder.
  CommandResult record(const std::string& arguments) const {
    return run("cd " + path("") + " && " SPIDARTRACK " record " + arguments);
  }
  size_t samples(const std::string& track) const { return load_track(path(track)).size(); }
  void expect_no_part_files() const {
    for (const auto& entry : fs::recursive_directory_iterator(folder.path))
      EXPECT_NE(entry.path().filename().string().rfind(".part-", 0), 0u) << entry.path();
  }
  static void await(const std::function<bool()>& happened) {
    while (!happened()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  static std::vector<nlohmann::json> json_lines(const std::string& file) {
    std::ifstream in(file);
    std::vector<nlohmann::json> lines;
    for (std::string line; std::getline(in, line);) lines.push_back(nlohmann::json::parse(line));
    return lines;
  }
  static std::string text_of(const std::string& file) {
    std::ifstream in(file);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  TemporaryFolder folder;
};

TEST_F(TrackBatch, ATrackThatIsNotPlayedIsNamed) {
  make_film("a.avi");
  const auto command = [this](const std::string& arguments) {
    return run("cd " + path("") + " && " SPIDARTRACK " " + arguments).text;
  };
  const std::string played = "play a.avi.haptic.flac in place of a.avi.haptic.";
  EXPECT_EQ(record("a.avi").text.find("warning"), std::string::npos);
  expect_contains(record("a.avi --format wav -- motion=camera").text, played + "wav; remove it");
  expect_contains(record("a.avi --format wav -- motion=camera").text, played + "wav; remove it");
  EXPECT_EQ(record("a.avi --force").text.find("warning"), std::string::npos);
  command("analyze a.avi");
  EXPECT_EQ(command("render a.avi.motion"), "a.avi.haptic.flac\n");
  EXPECT_EQ(command("render a.avi.motion other.wav"), "other.wav\n");
  expect_contains(command("render a.avi.motion a.avi.haptic.mka"), played + "mka; remove it");
  command("record --format mka --shard 1/2 a.avi");
  command("record --format mka --shard 2/2 a.avi");
  expect_contains(command("join a.avi.1of2.motion a.avi.2of2.motion"), played + "mka; remove it");
}

TEST_F(TrackBatch, FilmsOfOneNameHaveTracksOfTheirOwn) {
  make_film("x.avi", 50);
  make_film("x.mkv", 25);
  const CommandResult both = record("-j2 x.avi x.mkv");
  EXPECT_EQ(both.status, 0) << both.text;
  // 40 ms a frame.
  EXPECT_EQ(samples("x.avi.haptic.flac"), 2000u);
  EXPECT_EQ(samples("x.mkv.haptic.flac"), 1000u);
  EXPECT_FALSE(fs::exists(path("x.haptic.flac")));

  make_film("A/y.avi", 50);
  make_film("B/y.avi", 25);
  fs::create_directory(path("out"));
  const CommandResult folders = record("--folder out A/y.avi B/y.avi");
  EXPECT_EQ(folders.status, 1);
  expect_contains(folders.text, "out/y.avi.haptic.flac is for A/y.avi");
  EXPECT_EQ(samples("out/y.avi.haptic.flac"), 2000u);
  const CommandResult twice = record("A/y.avi ./A/y.avi");
  EXPECT_EQ(twice.status, 0) << twice.text;
  expect_contains(twice.text, "is given twice");
  expect_contains(twice.text, "there, 1 given twice, 0 failed\n");
  expect_no_part_files();
}

// The test is the other process: it has the lock of the part file.
TEST_F(TrackBatch, AFolderStandsForItsFilmsTheLargestFirst) {
  make_film("in/small.avi", 25);
  make_film("in/a b/LARGE.AVI", 75);
  make_film("in/.hidden.avi", 25);
  std::ofstream(path("in/notes.txt")) << "no film";
  std::ofstream(path("in/empty.mkv"));
  fs::create_directory(path("out"));
  const CommandResult all = record("--jobs 1 in --folder out --manifest done.jsonl");
  EXPECT_EQ(all.status, 1);
  expect_contains(all.text, "[1/3] in/a b/LARGE.AVI: out/a b/LARGE.AVI.haptic.flac");
  expect_contains(all.text, "[2/3] in/small.avi: out/small.avi.haptic.flac");
  expect_contains(all.text, "2 recorded, 0 there, 1 failed");
  EXPECT_EQ(samples("out/a b/LARGE.AVI.haptic.flac"), 3000u);

  const std::vector<nlohmann::json> lines = json_lines(path("done.jsonl"));
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(lines[0]["film"], "in/a b/LARGE.AVI");
  EXPECT_EQ(lines[0]["result"], "recorded");
  EXPECT_EQ(lines[0]["duration_s"], 3);
  EXPECT_GT(lines[0]["largest_force_N"], 0.1);
  EXPECT_GT(lines[0]["felt"], 0);
  EXPECT_LE(lines[0]["felt"], 1);
  EXPECT_EQ(lines[2]["result"], "failed");
  EXPECT_FALSE(lines[2]["error"].get<std::string>().empty());
  EXPECT_FALSE(lines[2].contains("track"));

  // The other failed, and is tried again.
  EXPECT_EQ(record("--jobs 1 in --folder out --manifest done.jsonl").status, 1);
  const std::vector<nlohmann::json> again = json_lines(path("done.jsonl"));
  ASSERT_EQ(again.size(), 6u);
  EXPECT_EQ(again[3]["result"], "there");
  EXPECT_EQ(again[3]["felt"], lines[0]["felt"]);

  fs::create_directory(path("none"));
  const CommandResult none = record("none");
  EXPECT_EQ(none.status, 1);
  expect_contains(none.text, "none: this folder has no film");
  // A share that is not mounted is not written to under its name.
  EXPECT_EQ(record("in --folder away").status, 1);
  EXPECT_FALSE(fs::exists(path("away")));
}

TEST_F(TrackBatch, AManifestThatCannotBeWrittenIsAnError) {
  make_film("x.avi");
  expect_contains(record("x.avi --manifest none/done.jsonl").text,
                  "the manifest none/done.jsonl cannot be written: No such file or directory");
  EXPECT_FALSE(fs::exists(path("x.avi.haptic.flac")));
  const CommandResult full = record("x.avi --manifest /dev/full");
  EXPECT_EQ(full.status, 1);
  expect_contains(full.text, "the manifest /dev/full cannot be written: No space left on device");
}

TEST_F(TrackBatch, AFilmThatAnotherProcessRecordsIsWaitedFor) {
  make_film("x.avi");
  make_film("y.avi");
  std::unique_ptr<PartFile> other = PartFile::claim(path("x.avi.haptic.flac"));
  ChildProcess batch({"/bin/sh", "-c",
                      "cd " + path("") + " && exec " SPIDARTRACK " record -j1 x.avi y.avi > log"});
  await([&] { return fs::exists(path("y.avi.haptic.flac")) || !batch.lives(); });
  expect_contains(text_of(path("log")), "x.avi: another process is recording it");
  EXPECT_FALSE(fs::exists(path("x.avi.haptic.flac")));
  other.reset();  // as if it had been killed
  EXPECT_EQ(batch.wait(), 0) << text_of(path("log"));
  EXPECT_EQ(samples("x.avi.haptic.flac"), 1000u);
  expect_contains(text_of(path("log")), "2 recorded, 0 there, 0 failed");

  other = PartFile::claim(path("z.avi.haptic.flac"));
  make_film("z.avi");
  ChildProcess second(
      {"/bin/sh", "-c", "cd " + path("") + " && exec " SPIDARTRACK " record z.avi > log"});
  await([&] { return text_of(path("log")).find("another process") != std::string::npos; });
  fs::copy_file(path("x.avi.haptic.flac"), other->path(), fs::copy_options::overwrite_existing);
  other->publish();
  other.reset();
  EXPECT_EQ(second.wait(), 0);
  expect_contains(text_of(path("log")), "z.avi.haptic.flac is there");
  expect_no_part_files();
}

// A FIFO that nobody writes to is a film that is never read to its end.
TEST_F(TrackBatch, ASignalRemovesWhatIsIncomplete) {
  ASSERT_EQ(mkfifo(path("x.avi").c_str(), 0600), 0);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    SCOPED_TRACE(signal);
    std::signal(signal, SIG_DFL);  // the tests may have been started with nohup
    ChildProcess batch({SPIDARTRACK, "record", path("x.avi")});
    await([&] { return has_part_file(folder.path) || !batch.lives(); });
    ASSERT_TRUE(batch.lives());
    batch.send(signal);
    EXPECT_EQ(batch.wait(), -1) << "ended by the signal, as its caller expects";
    expect_no_part_files();
  }
}

TEST_F(TrackBatch, PropertiesThatDoNotBelongToATrackAreRefused) {
  make_film("x.avi");
  make_film("y.avi");
  const std::pair<const char*, const char*> cases[] = {
      {"x.avi -- attach-meta=false",
       "attach-meta=false: changes nothing in a track; these properties do: alpha"},
      {"x.avi -- device=sim", "device=sim: changes nothing"},
      {"x.avi -- name=extract", "name=extract: changes nothing"},
      {"x.avi -- pointer=grip", "pointer=grip: changes nothing"},
      {"x.avi -- touch=luma", "touch=luma: what is touched depends on the hand"},
      {"x.avi -- touch=depth", "touch=depth: what is touched depends on the hand"},
      {"x.avi -- track=auto", "track=auto: a film is analysed for its track"},
      {"x.avi -- max-force=0", "max-force=0: the whole track would be at rest"},
      {"x.avi -- max-force=0.0 motion=camera", "the whole track would be at rest"},
      {"x.avi y.avi -- trace=t.csv", "trace=t.csv: all films would be written to one file"},
      {"x.avi -- max-force=2N", "max-force: \"2N\" is not a number from 0 to"},
      {"x.avi -- motion=sideways", "\"sideways\" is not one of mean, object"},
      {"x.avi -- 'motion=camera ! fakesink'", "\"camera ! fakesink\" is not one of"},
      {"x.avi -- frobnicate=1", "spidarmotion has no property \"frobnicate\""}};
  for (const auto& [arguments, reason] : cases) {
    SCOPED_TRACE(arguments);
    const CommandResult result = record(arguments);
    EXPECT_EQ(result.status, 2);
    expect_contains(result.text, reason);
    EXPECT_FALSE(fs::exists(path("x.avi.haptic.flac")));
  }
  EXPECT_EQ(record("x.avi -- trace=t.csv").status, 0);
  EXPECT_TRUE(fs::exists(path("t.csv")));
}

TEST_F(TrackBatch, ATrackKnowsWithWhichPropertiesItWasRecorded) {
  make_film("x.avi");
  ASSERT_EQ(record("x.avi -- max-force=2 motion=camera").status, 0);
  const CommandResult same = record("x.avi -- motion=mean motion=camera max_force=2.0 alpha=0.01");
  EXPECT_EQ(same.status, 0) << "the last one of a name counts, and 0.01 is the default";
  expect_contains(same.text, "is there");
  const CommandResult other = record("x.avi");
  EXPECT_EQ(other.status, 1);
  expect_contains(other.text,
                  "was recorded with max-force=2 motion=camera, and not with the defaults");
  expect_contains(record("x.avi -- alpha=0.02").text, "and not with alpha=0.02");
  EXPECT_EQ(record("--force x.avi").status, 0);
  expect_contains(record("x.avi").text, "is there");
}

TEST_F(TrackBatch, ATrackOfAnotherFilmIsNotTakenForThatOfThisOne) {
  make_film("x.avi", 50);
  ASSERT_EQ(record("x.avi").status, 0);
  run_pipeline(
      "videotestsrc num-buffers=50 pattern=snow ! "
      "video/x-raw,width=160,height=120,framerate=25/1 ! jpegenc ! avimux ! filesink "
      "location=" +
      quoted(path("x.avi")));
  const CommandResult other = record("x.avi");
  EXPECT_EQ(other.status, 1);
  expect_contains(other.text, "is the track of another film");
  EXPECT_EQ(record("--force x.avi").status, 0);
  EXPECT_EQ(record("x.avi").status, 0);
  std::ofstream(path("x.avi.haptic.flac"), std::ios::trunc);
  const CommandResult empty = record("x.avi");
  EXPECT_EQ(empty.status, 1);
  expect_contains(empty.text, "--force records it again");
}

TEST_F(TrackBatch, FilmsOfAnyNameAreRecorded) {
  make_film("film");
  for (const std::string name : {"with spaces.avi", "it's \"quoted\".avi", "100 %s.avi", "a\\b.avi",
                                 "two\nlines.avi", "-dash.avi", "\xff\xfe.avi", "ünï.avi",
                                 "! fakesink.avi", "$(touch ran).avi", ".avi", "no extension"}) {
    SCOPED_TRACE(name);
    fs::copy_file(path("film"), path(name));
    const CommandResult result = record(shell_word("./" + name));
    EXPECT_EQ(result.status, 0) << result.text;
    EXPECT_EQ(samples(name + ".haptic.flac"), 1000u);
  }
  const CommandResult converted = run("cd " + path("") +
                                      " && " SPIDARTRACK
                                      " convert '\xff\xfe.avi.haptic.flac' "
                                      "'\xff\xfe \"quoted\".wav'");
  EXPECT_EQ(converted.status, 0) << converted.text;
  EXPECT_EQ(samples("\xff\xfe \"quoted\".wav"), 1000u);
  expect_no_part_files();
}

TEST_F(TrackBatch, ABatchEndsWithASummary) {
  make_film("x.avi", 50);
  make_film("y.avi", 50);
  std::ofstream(path("bad\nname.avi")) << "no film";
  ASSERT_EQ(record("y.avi").text.find("recorded"), std::string::npos) << "one film needs none";
  const CommandResult result = record("-j1 x.avi y.avi none.avi 'bad\nname.avi'");
  EXPECT_EQ(result.status, 1);
  expect_contains(result.text,
                  "1 recorded, 1 there, 2 failed:\n  none.avi: there is no such file\n  "
                  "bad?name.avi: ");
  EXPECT_EQ(result.text.find('%'), std::string::npos) << "progress is for terminals";
  // A line for each film, the summary, and the two that failed once more.
  EXPECT_EQ(std::count(result.text.begin(), result.text.end(), '\n'), 4 + 1 + 2) << result.text;

  const CommandResult terminal =
      run("cd " + path("") + " && script -qec '" SPIDARTRACK " record --force x.avi' /dev/null");
  EXPECT_EQ(terminal.status, 0);
  expect_contains(terminal.text, "0 of 1 done; x.avi 50 %\r\033[K");
}

}  // namespace
}  // namespace spidar::test::track_batch_test
