// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// A long film is recorded in pieces, which together are what one run makes, byte by byte.
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include <gst/gst.h>
#include <gtest/gtest.h>

#include "tests/pipelines/track_command.h"
#include "tests/support/child_process.h"
#include "tests/support/temporary_folder.h"

namespace spidar::test::pieces_test {
namespace {

namespace fs = std::filesystem;

/// Four scenes of 1.2 s, four times, with key frames elsewhere than at the cuts.
constexpr const char* kCuts =
    "-f lavfi -i testsrc2=s=160x120:r=25:d=1.2 -f lavfi -i mandelbrot=s=160x120:r=25 "
    "-f lavfi -i life=s=160x120:r=25:mold=10:ratio=0.3:seed=1 "
    "-f lavfi -i smptehdbars=s=160x120:r=25:d=1.2 -filter_complex "
    "'[0:v]format=yuv420p[a];[1:v]trim=duration=1.2,format=yuv420p[b];"
    "[2:v]trim=duration=1.2,format=yuv420p[c];[3:v]format=yuv420p,scroll=h=0.02[d];"
    "[a][b][c][d]concat=n=4,loop=3:120,setpts=N/25/TB";
constexpr const char* kEnd = "[o]' -map '[o]' -c:v mpeg4 -q:v 4 -g 17 -y ";

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class Pieces : public testing::Test {
 protected:
  static void SetUpTestSuite() { gst_init(nullptr, nullptr); }

  std::string path(const std::string& name) const { return (folder.path / name).string(); }
  /// Runs it in the folder.
  CommandResult command(const std::string& arguments) const {
    return run("cd " + path("") + " && " SPIDARTRACK " " + arguments);
  }
  void ffmpeg(const std::string& arguments) const {
    const CommandResult made = run("cd " + path("") + " && ffmpeg -v error " + arguments);
    ASSERT_EQ(made.status, 0) << made.text;
  }
  void make_cuts(const std::string& name, const std::string& filter = "",
                 const std::string& options = "") const {
    ffmpeg(kCuts + filter + kEnd + options + shell_word(name));
  }
  size_t frames(const std::string& analysis) const {
    const CommandResult info = command("info --json " + shell_word(analysis));
    return nlohmann::json::parse(info.text)["frames"];
  }
  void measure(const std::string& film, int pieces, const std::string& options = "") const {
    for (int k = 1; k <= pieces; ++k) {
      const CommandResult one =
          command("record --shard " + std::to_string(k) + "/" + std::to_string(pieces) + " " +
                  shell_word(film) + " " + options);
      EXPECT_EQ(one.status, 0) << one.text;
    }
  }
  void expect_same(const std::string& film, int pieces, const std::string& options = "") const {
    SCOPED_TRACE(film + " in " + std::to_string(pieces));
    measure(film, pieces, options);
    const std::string track = path(film + ".haptic.flac");
    fs::remove(track);
    const CommandResult join =
        command("join " + shell_word(film) + ".*of" + std::to_string(pieces) + ".motion");
    EXPECT_EQ(join.status, 0) << join.text;
    EXPECT_EQ(join.text, film + ".haptic.flac\n");
    EXPECT_TRUE(bytes_of(track) == bytes_of(path("whole.flac")));
  }
  void record_whole(const std::string& film, const std::string& options = "") const {
    const CommandResult whole = command("record --force " + shell_word(film) + " " + options);
    ASSERT_EQ(whole.status, 0) << whole.text;
    fs::rename(path(film + ".haptic.flac"), path("whole.flac"));
  }
  void expect_refused(const std::string& arguments, int status, const std::string& why) const {
    const CommandResult result = command(arguments);
    EXPECT_EQ(result.status, status) << arguments;
    expect_contains(result.text, why);
  }

  TemporaryFolder folder;
};

TEST_F(Pieces, AreTheTrackOfOneRunAndEachASmallPart) {
  const std::string film = "a film, 'quoted' 1of2.mp4";
  make_cuts(film);
  record_whole(film);
  for (int pieces = 1; pieces <= 5; ++pieces) expect_same(film, pieces);
  // 480 frames: a piece of three goes on for less than two scenes after its end, and the common
  // past of a second.
  EXPECT_LE(frames(film + ".1of3.motion"), 160u + 25 + 3 * 30);
  EXPECT_LE(frames(film + ".2of3.motion"), 160u + 25 + 3 * 30);
  EXPECT_EQ(frames(film + ".3of3.motion"), 160u);
}

TEST_F(Pieces, OfAFilmWithoutACutAreMeasuredByTheFirst) {
  ffmpeg("-f lavfi -i testsrc2=s=160x120:r=25:d=6 -c:v mpeg4 -g 17 nocut.avi");
  record_whole("nocut.avi");
  expect_same("nocut.avi", 3);
  EXPECT_EQ(frames("nocut.avi.1of3.motion"), 150u);
  const CommandResult again = command("record --force --shard 2/3 nocut.avi");
  expect_contains(again.text, "there is no cut in it at which it could begin");
  // It does not go on to the end for nothing.
  EXPECT_LE(frames("nocut.avi.2of3.motion"), 51u);
}

TEST_F(Pieces, OfRepeatedPicturesAndTimesThatVaryToo) {
  make_cuts("repeats.mp4", ",fps=10,fps=25");
  record_whole("repeats.mp4", "-- motion=camera max-force=2");
  for (const int pieces : {2, 3}) {
    expect_same("repeats.mp4", pieces, "-- motion=camera max-force=2");
  }
  make_cuts("varies.mkv", ",select=not(eq(mod(n\\,7)\\,3))+gt(mod(n\\,50)\\,30)", "-fps_mode vfr ");
  record_whole("varies.mkv");
  for (const int pieces : {2, 4}) expect_same("varies.mkv", pieces);
}

TEST_F(Pieces, OfAStreamWithoutAnIndexToo) {
  make_cuts("stream.ts");
  record_whole("stream.ts");
  expect_same("stream.ts", 3);
}

TEST_F(Pieces, OfAnAnalysisAreThatAnalysis) {
  make_cuts("film.mp4");
  EXPECT_EQ(command("analyze film.mp4 -- quality=fine").status, 0);
  const std::string whole = bytes_of(path("film.mp4.motion"));
  for (const char* shard : {"1/2", "2/2"}) {
    EXPECT_EQ(command(std::string("analyze film.mp4 --shard ") + shard + " -- quality=fine").status,
              0);
  }
  EXPECT_EQ(command("join film.mp4.2of2.motion film.mp4.1of2.motion").text, "film.mp4.motion\n");
  EXPECT_TRUE(bytes_of(path("film.mp4.motion")) == whole);
}

TEST_F(Pieces, AWrongSetOfThemIsNamed) {
  make_cuts("film.mp4");
  make_cuts("other.mp4", ",negate");
  measure("film.mp4", 3);
  measure("other.mp4", 3);
  const std::string first = "join film.mp4.1of3.motion ";
  const std::string third = " film.mp4.3of3.motion";
  expect_refused(first + third, 1, "piece 2 is missing");
  expect_refused(first + "film.mp4.2of3.motion", 1, "film.mp4: piece 3 of 3 is missing");
  expect_refused(first + "other.mp4.2of3.motion" + third, 1, "it is of another film than piece 1");
  expect_refused(first + "./film.mp4.1of3.motion", 2, "they are the same piece");
  expect_refused(first + "film.mp4", 1, "film.mp4: it is no analysis of a film");
  expect_refused("render film.mp4.1of3.motion", 1, "piece 1 of 3 of an analysis: spidartrack join");
  command("record --force --shard 2/3 film.mp4 -- max-force=2");
  expect_refused(first + "film.mp4.2of3.motion" + third, 1,
                 "it was measured with max-force=2 for flac, and piece 1 with the defaults");
  fs::resize_file(path("film.mp4.2of3.motion"), fs::file_size(path("film.mp4.2of3.motion")) - 3);
  expect_refused(first + "film.mp4.2of3.motion" + third, 1, "its end is missing");
  EXPECT_FALSE(fs::exists(path("film.mp4.haptic.flac")));
}

TEST_F(Pieces, OfWhatHasNoneAreRefused) {
  std::ofstream(path("empty.mp4")).close();
  expect_refused("record --shard 1/2 empty.mp4", 1, "empty.mp4: ");
  expect_refused("record --shard 2/2 empty.mp4", 1, "empty.mp4: ");
  EXPECT_FALSE(fs::exists(path("empty.mp4.2of2.motion")));
  for (const char* shard : {"3/2", "0/2", "1", "/", "a/b", "1/0", "1.5/2"}) {
    expect_refused(std::string("record empty.mp4 --shard ") + shard, 2, "--shard");
  }
  expect_refused("record --shard 1/2 empty.mp4 -- motion=mean", 2,
                 "motion=mean follows its points");
  expect_refused("record --shard 1/2 empty.mp4 -- trace=a.csv", 2, "render");
  expect_refused("record --shard 1/2 --manifest m.jsonl empty.mp4", 2, "--manifest");
  expect_refused("join", 2, "no PIECE given");
}

TEST_F(Pieces, APieceThatWasKilledIsMeasuredAgainAndTheOthersAreNot) {
  make_cuts("film.mp4");
  record_whole("film.mp4");
  measure("film.mp4", 2);
  fs::remove(path("film.mp4.2of2.motion"));
  {
    ChildProcess killed({SPIDARTRACK, "record", "--shard", "2/2", path("film.mp4")});
    while (!has_part_file(folder.path) && !fs::exists(path("film.mp4.2of2.motion"))) {
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    killed.end(SIGKILL);
  }
  const CommandResult first = command("record --shard 1/2 film.mp4");
  expect_contains(first.text, "is there");
  expect_same("film.mp4", 2);
}

}  // namespace
}  // namespace spidar::test::pieces_test
