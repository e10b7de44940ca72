// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// What spidartrack does when an output cannot be written, when it is interrupted, and with names
// that mean something to a shell or to gnuplot.
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include <gst/gst.h>
#include <gtest/gtest.h>

#include "core/track/track_format.h"
#include "plugin/tools/track_samples.h"
#include "tests/pipelines/track_command.h"
#include "tests/support/child_process.h"
#include "tests/support/temporary_folder.h"

namespace spidar::test::track_output_test {
namespace {

namespace fs = std::filesystem;

class TrackOutput : public testing::Test {
 protected:
  static void SetUpTestSuite() { gst_init(nullptr, nullptr); }

  std::string path(const std::string& name) const { return (folder.path / name).string(); }
  std::set<std::string> files() const {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder.path))
      names.insert(entry.path().filename().string());
    return names;
  }
  /// A hundred samples.
  void save(const std::string& name, size_t count = 100) const {
    std::vector<TrackSample> track(count);
    for (size_t i = 0; i < track.size(); ++i) {
      const auto x = static_cast<float>(0.1 * std::sin(0.01 * static_cast<double>(i * i)));
      track[i] = {x, 2 * x, -3 * x, x / 2, -x / 3, x / 4};
    }
    save_track(path(name), track);
  }
  static bool has_gnuplot() { return std::system("gnuplot --version > /dev/null 2>&1") == 0; }
  std::string start_of(const std::string& name) const {
    std::ifstream file(path(name), std::ios::binary);
    std::string bytes(4, '\0');
    file.read(bytes.data(), 4);
    return bytes;
  }

  TemporaryFolder folder;
};

TEST_F(TrackOutput, ARecordingThatCannotBeWrittenSaysWhy) {
  // More than filesink buffers, which are 64 KiB: 4 s of WAV are 96 kB.
  run_pipeline(
      "videotestsrc num-buffers=100 pattern=ball ! "
      "video/x-raw,width=160,height=120,framerate=25/1 ! jpegenc ! avimux ! filesink "
      "location=" +
      quoted(path("a.avi")));
  const std::set<std::string> before = files();
  for (const char* format : {"flac", "mka", "wav"}) {
    SCOPED_TRACE(format);
    const CommandResult result = run("cd " + path("") + " && trap '' XFSZ && ulimit -f 2 && " +
                                     SPIDARTRACK " record a.avi --format " + format);
    EXPECT_EQ(result.status, 1) << result.text;
    // filesink's words, and not those of the encoder that ends because of it.
    expect_contains(result.text, "failed: Could not write to resource.");
    EXPECT_EQ(files(), before);
  }
}

TEST_F(TrackOutput, APlotRunsNoCommandThatANameContains) {
  if (!has_gnuplot()) GTEST_SKIP() << "gnuplot is not installed";
  save("a.flac");
  for (const std::string name :
       {"|touch ran", "< touch ran", "it's.png", "'; system 'touch ran'; a='", "`touch ran`",
        "$(touch ran)", "two\nlines.png", "100%s.png", "\xff\xfe.png"}) {
    SCOPED_TRACE(name);
    const CommandResult result =
        run("cd " + path("") + " && " SPIDARTRACK " plot a.flac " + shell_word(name));
    EXPECT_EQ(result.status, 0) << result.text;
    EXPECT_EQ(start_of(name), "\x89PNG");
    EXPECT_FALSE(fs::exists(path("ran")));
  }
}

TEST_F(TrackOutput, APlotWithoutGnuplotSaysWhatIsMissing) {
  save("a.flac");
  const std::set<std::string> before = files();
  const CommandResult result =
      run("PATH=/nowhere " SPIDARTRACK " plot " + path("a.flac") + " " + path("a.png"));
  EXPECT_EQ(result.status, 1);
  expect_contains(result.text, "Debian package gnuplot-nox");
  EXPECT_EQ(files(), before);
}

// A limit of the size of a file stands for a full disk, because a test cannot mount one: the write
// fails in the same way, with another reason.
TEST_F(TrackOutput, WhatCannotBeWrittenIsAnErrorAndLeavesNothing) {
  save("a.flac", 1000);  // more than 4 KiB in every format
  const std::set<std::string> before = files();
  std::vector<std::string> commands = {"convert a.flac b.flac",
                                       "convert a.flac b.mka",
                                       "convert a.flac b.wav",
                                       "convert a.flac b.hjif",
                                       "convert a.flac b.ahap",
                                       "convert a.flac b.funscript",
                                       "convert a.flac b.wav --rate 48000"};
  if (has_gnuplot()) commands.emplace_back("plot a.flac b.png");
  for (const std::string& command : commands) {
    SCOPED_TRACE(command);
    const CommandResult result =
        run("cd " + path("") + " && trap '' XFSZ && ulimit -f 8 && " SPIDARTRACK " " + command);
    EXPECT_EQ(result.status, 1) << result.text;
    EXPECT_FALSE(result.text.empty());
    EXPECT_EQ(files(), before);
  }
}

// gnuplot is replaced by a program that runs until spidartrack has ended, so that the signal comes
// while the picture is being drawn.
TEST_F(TrackOutput, ASignalRemovesWhatIsIncomplete) {
  save("a.flac");
  fs::create_directory(path("bin"));
  std::ofstream(path("bin/gnuplot"))
      << "#!/bin/sh\ntouch " << path("bin/drawing")
      << "\ncat > /dev/null\nwhile kill -0 $PPID; do sleep 0.02; done 2> /dev/null\n";
  fs::permissions(path("bin/gnuplot"), fs::perms::owner_all);
  const std::set<std::string> before = files();
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    SCOPED_TRACE(signal);
    std::signal(signal, SIG_DFL);  // the tests may have been started with nohup
    ChildProcess plot({SPIDARTRACK, "plot", path("a.flac"), path("a.png")},
                      {"PATH=" + path("bin") + ":/usr/bin:/bin"});
    while (plot.lives() && !fs::exists(path("bin/drawing")))
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    ASSERT_TRUE(plot.lives());
    EXPECT_TRUE(has_part_file(folder.path));
    fs::remove(path("bin/drawing"));
    plot.send(signal);
    EXPECT_EQ(plot.wait(), -1) << "ended by the signal, as its caller expects";
    EXPECT_EQ(files(), before);
  }
}

/// 4 GB of addresses, so that a track without bounds fails and does not take all memory. The
/// address sanitizer reserves more than that.
#ifdef __SANITIZE_ADDRESS__
#define BOUNDED ""
#else
#define BOUNDED "ulimit -v 4000000; "
#endif

TEST_F(TrackOutput, ATraceWithAWildTimeIsRefused) {
  const std::string head =
      "running_time_ns,stream_time_ns,features,tracked,velocity_x_px_s,velocity_y_px_s,force_x_N,"
      "force_y_N,force_z_N,torque_x_Nm,torque_y_Nm,torque_z_Nm,limit\n";
  const std::string rest = ",10,10,0,0,1,0,0,0,0,0,none\n";
  const std::pair<const char*, const char*> times[] = {{"1000000000000000", "1e+06 s"},
                                                       {"1e300", "1e+291 s"},
                                                       {"-40000000", "-0.04 s"},
                                                       {"nan", "nan s"}};
  for (const auto& [time, shown] : times) {
    SCOPED_TRACE(time);
    std::ofstream(path("wild.csv")) << head << "0,0" << rest << "40000000," << time << rest;
    const CommandResult result =
        run(BOUNDED SPIDARTRACK " convert " + path("wild.csv") + " " + path("a.wav"));
    EXPECT_EQ(result.status, 1);
    expect_contains(result.text, "wild.csv:3: the stream time is ");
    expect_contains(result.text, shown);
    expect_contains(result.text, "must be from 0 to 86400 s");
  }
  // −1 is what the element writes for a frame outside the segment.
  std::ofstream(path("good.csv")) << head << "0,-1" << rest << "0,0" << rest << "40000000,40000000"
                                  << rest;
  EXPECT_EQ(spidartrack("convert " + path("good.csv") + " " + path("good.wav")).status, 0);
  EXPECT_EQ(load_track(path("good.wav")).size(), 80u) << "two frames of 40 ms";

  std::ofstream(path("wild.jsonl"))
      << R"({"stream_time_ns":1000000000000000,"repeated":false,"restarted":false,)"
      << R"("wrench":{"force_N":[1,0,0],"torque_Nm":[0,0,0]}})" << '\n';
  const CommandResult json =
      run(BOUNDED SPIDARTRACK " convert " + path("wild.jsonl") + " " + path("a.wav"));
  EXPECT_EQ(json.status, 1);
  expect_contains(json.text, "wild.jsonl:1: the stream time is 1e+06 s");
}

TEST_F(TrackOutput, AJumpOfDaysIsNamedAndNotFilledWithSilence) {
  if (std::system("ffmpeg -version > /dev/null 2>&1") != 0) {
    GTEST_SKIP() << "ffmpeg is not installed";
  }
  save("a.wav", 1000);
  // The second half is 10^6 s later.
  ASSERT_EQ(run("ffmpeg -nostdin -v error -i " + path("a.wav") +
                " -af 'asetnsamples=100,asetpts=PTS+gte(N\\,5)*1000000000' -c:a pcm_f32le " +
                path("jump.mka"))
                .text,
            "");
  const CommandResult result =
      run(BOUNDED SPIDARTRACK " convert " + path("jump.mka") + " " + path("b.wav"));
  EXPECT_EQ(result.status, 1);
  expect_contains(result.text, "reach to 1000000 s, and a track lasts at most 24 h");
}

TEST_F(TrackOutput, MessagesNameTheOutputThatWasGiven) {
  save("a.flac");
  std::vector<std::string> commands = {"convert a.flac none/b.flac", "convert a.flac none/b.hjif"};
  if (has_gnuplot()) commands.emplace_back("plot a.flac none/b.png");
  for (const std::string& command : commands) {
    SCOPED_TRACE(command);
    const CommandResult result = run("cd " + path("") + " && " SPIDARTRACK " " + command);
    EXPECT_EQ(result.status, 1);
    expect_contains(result.text, "spidartrack: none/b.");
    expect_contains(result.text, ": there is no folder none\n");
  }
  const CommandResult uri = spidartrack("convert " + path("a.flac") + " file:///tmp/b.flac");
  EXPECT_EQ(uri.status, 1);
  expect_contains(uri.text, "file:///tmp/b.flac: there is no folder file:///tmp; a file name is");
}

TEST_F(TrackOutput, MistakesAreNamed) {
  save("a.flac");
  const std::string a = path("a.flac");
  const CommandResult jpeg = spidartrack("plot " + a + " " + path("a.jpg"));
  EXPECT_EQ(jpeg.status, 2);
  expect_contains(jpeg.text, "a.jpg: the picture is a PNG");
  const CommandResult same = run("cd " + path("") + " && " SPIDARTRACK " convert a.flac ./a.flac");
  EXPECT_EQ(same.status, 2);
  expect_contains(same.text, "./a.flac: is to be another file than a.flac");
  const CommandResult property = spidartrack("record film.mp4 motion=camera");
  EXPECT_EQ(property.status, 2);
  expect_contains(property.text, "spidartrack record FILM -- motion=camera");

  ASSERT_EQ(spidartrack("convert " + a + " " + path("a.ahap")).status, 0);
  const CommandResult ahap = spidartrack("info " + path("a.ahap"));
  EXPECT_EQ(ahap.status, 1);
  expect_contains(ahap.text, "written, but not read");
  const CommandResult rate = spidartrack("convert " + a + " " + path("a.hjif") + " --rate 48000");
  EXPECT_EQ(rate.status, 2);
  expect_contains(rate.text, "--rate is for sound (.flac, .mka, .wav), not for");

  std::ofstream(path("empty.csv"))
      << "running_time_ns,stream_time_ns,features,tracked,velocity_x_px_s,velocity_y_px_s,"
         "force_x_N,force_y_N,force_z_N,torque_x_Nm,torque_y_Nm,torque_z_Nm,limit\n";
  const CommandResult empty = spidartrack("convert " + path("empty.csv") + " " + path("b.flac"));
  EXPECT_EQ(empty.status, 1);
  expect_contains(empty.text, "empty.csv: is a trace without frames");
}

TEST_F(TrackOutput, WhatGnuplotSaysIsPartOfTheMessage) {
  save("a.flac");
  fs::create_directory(path("bin"));
  std::ofstream(path("bin/gnuplot")) << "#!/bin/sh\necho some warning >&2\ncat > /dev/null\n"
                                        "echo no terminal >&2\nexit 1\n";
  fs::permissions(path("bin/gnuplot"), fs::perms::owner_all);
  EXPECT_EQ(run("PATH=" + path("bin") + ":$PATH " SPIDARTRACK " plot " + path("a.flac") + " " +
                path("a.png"))
                .text,
            "spidartrack: gnuplot could not draw the picture: no terminal\n");
}

TEST_F(TrackOutput, InfoOfAFilmIsThatOfItsTrack) {
  for (const std::string name : {"film.avi", "two\nlines.avi", "a\"b\\.avi", "\xff\xfe.avi"}) {
    SCOPED_TRACE(name);
    run_pipeline(
        "videotestsrc num-buffers=25 ! video/x-raw,width=64,height=48,framerate=25/1 ! jpegenc ! "
        "avimux ! filesink location=" +
        quoted(path("made.film")));
    fs::rename(path("made.film"), path(name));
    const auto info = [&](const std::string& options) {
      return spidartrack("info " + shell_word(path(name)) + options);
    };
    EXPECT_EQ(info("").status, 1);
    expect_contains(info("").text, "a film without a haptic track, inside it or beside it");
    for (const bool belongs : {true, false}) {
      save("made.wav", belongs ? 1000 : 1500);
      fs::rename(path("made.wav"), path(name + ".haptic.wav"));
      const CommandResult plain = info("");
      EXPECT_EQ(plain.status, 0) << plain.text;
      expect_contains(plain.text, "the haptic track is beside the film");
      EXPECT_EQ(plain.text.find("of another film") == std::string::npos, belongs) << plain.text;
      const CommandResult json = info(" --json");
      const nlohmann::json read = nlohmann::json::parse(json.text, nullptr, false);
      ASSERT_FALSE(read.is_discarded()) << json.text;
      EXPECT_EQ(read["belongs"], belongs);
      if (name[0] != '\xff') {
        EXPECT_EQ(read["film"], path(name));
      }
    }
  }
}

}  // namespace
}  // namespace spidar::test::track_output_test
