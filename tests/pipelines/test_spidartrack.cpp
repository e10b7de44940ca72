// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// spidartrack as a user sees it: exit status, messages, files.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include <gst/gst.h>
#include <gtest/gtest.h>

#include "core/track/track_format.h"
#include "plugin/tools/track_samples.h"
#include "tests/pipelines/track_command.h"
#include "tests/support/temporary_folder.h"

namespace spidar::test::spidartrack_test {
namespace {

namespace fs = std::filesystem;

class Spidartrack : public testing::Test {
 protected:
  static void SetUpTestSuite() { gst_init(nullptr, nullptr); }

  std::string path(const std::string& name) const { return (folder.path / name).string(); }
  void make_film(const std::string& name) const {
    run_pipeline(
        "videotestsrc num-buffers=50 pattern=ball ! "
        "video/x-raw,width=320,height=240,framerate=25/1 "
        "! jpegenc ! avimux ! filesink location=" +
        quoted(path(name)));
  }
  /// Two seconds with six different channels.
  std::vector<TrackSample> samples() const {
    std::vector<TrackSample> track;
    for (int i = 0; i < 2000; ++i) {
      const auto x = static_cast<float>(0.05 * std::sin(0.01 * i));
      track.push_back({x, 2 * x, -3 * x, x / 2, -x / 3, x / 4});
    }
    return track;
  }

  TemporaryFolder folder;
};

TEST_F(Spidartrack, HelpSucceedsAndWrongUsageSaysWhatWouldBeRight) {
  EXPECT_EQ(spidartrack("--help").status, 0);
  for (const char* command : {"record", "analyze", "render", "info", "check", "convert", "plot"}) {
    const CommandResult help = spidartrack(std::string(command) + " --help");
    EXPECT_EQ(help.status, 0);
    expect_contains(help.text, std::string("usage: spidartrack ") + command);
    EXPECT_EQ(spidartrack(command).status, 2) << command;
  }
  expect_contains(spidartrack("frobnicate").text, "commands are record, analyze, join, render");
  expect_contains(spidartrack("record x.mp4 --format ogg").text, "none of flac, mka, wav");
  expect_contains(spidartrack("record x.mp4 -- motion").text, "is no PROPERTY=VALUE");
}

TEST_F(Spidartrack, RecordsFilmsBesideThemAndGoesOnWhereItWas) {
  make_film("a film.avi");
  make_film("b.avi");
  const std::string films = quoted(path("a film.avi")) + " " + path("b.avi");
  const CommandResult first = spidartrack("record -j2 " + films);
  EXPECT_EQ(first.status, 0) << first.text;
  ASSERT_TRUE(fs::exists(path("a film.avi.haptic.flac")));
  for (const char* film : {"[1/2] ", "[2/2] "}) expect_contains(first.text, film);
  const std::vector<TrackSample> track = load_track(path("b.avi.haptic.flac"));
  EXPECT_EQ(track.size(), 2000u);
  EXPECT_GT(largest_difference(track, std::vector<TrackSample>(2000)), 0.1);

  const fs::file_time_type written = fs::last_write_time(path("b.avi.haptic.flac"));
  expect_contains(spidartrack("record " + films).text, "is there");
  EXPECT_EQ(fs::last_write_time(path("b.avi.haptic.flac")), written);

  const CommandResult missing = spidartrack("record " + path("none.avi"));
  EXPECT_EQ(missing.status, 1);
  expect_contains(missing.text, "there is no such file");
  EXPECT_EQ(spidartrack("record --format wav " + path("b.avi") + " -- max-force=1").status, 0);
  for (const TrackSample& sample : load_track(path("b.avi.haptic.wav"))) {
    ASSERT_LE(to_wrench(sample).force_N.norm(), 1 + 1e-6);
  }
  for (const auto& entry : fs::directory_iterator(folder.path)) {
    EXPECT_NE(entry.path().filename().string().rfind(".part-", 0), 0u) << entry.path();
  }
}

TEST_F(Spidartrack, ConvertsBetweenAllThatItKnows) {
  const std::vector<TrackSample> original = samples();
  save_track(path("a.wav"), original);
  // Half a step of 24 bits, and what a float below 1 is rounded by; of HJIF the tolerance and half
  // a step of 1e-5 as well.
  const double half_step = std::ldexp(1.0, -24) + std::ldexp(1.0, -25);
  const std::pair<std::string, double> steps[] = {{"a.mka", 0},
                                                  {"b.flac", half_step},
                                                  {"c.wav", half_step},
                                                  {"d.hjif", 4.1e-4},
                                                  {"e.mka", 4.1e-4}};
  std::string from = path("a.wav");
  for (const auto& [name, error] : steps) {
    const CommandResult result = spidartrack("convert " + from + " " + path(name));
    EXPECT_EQ(result.status, 0) << result.text;
    const std::vector<TrackSample> read = load_track(path(name));
    EXPECT_EQ(read.size(), original.size()) << name;
    EXPECT_LE(largest_difference(read, original), error) << name;
    from = path(name);
  }
  EXPECT_EQ(spidartrack("convert " + path("a.wav") + " " + path("a.txt")).status, 1);
}

TEST_F(Spidartrack, ATraceBecomesTheTrackThatExtractGives) {
  make_film("film.avi");
  for (const std::string trace : {"film.csv", "film.jsonl"}) {
    SCOPED_TRACE(trace);
    run_pipeline("filesrc location=" + quoted(path("film.avi")) +
                 " ! decodebin ! videoconvert ! spidarmotion device=none attach-meta=true trace=" +
                 quoted(path(trace)) +
                 " ! spidarextract name=x x.wrench ! wavenc ! filesink location=" +
                 quoted(path("film.wav")));
    const std::vector<TrackSample> traced = load_track(path(trace));
    const std::vector<TrackSample> extracted = load_track(path("film.wav"));
    ASSERT_EQ(traced.size(), extracted.size());
    EXPECT_LE(largest_difference(traced, extracted), 1e-6);
  }
  std::ofstream(path("bad.jsonl"), std::ios::app) << "{\"wrench\":3}\n";
  const CommandResult bad = spidartrack("convert " + path("bad.jsonl") + " " + path("bad.wav"));
  EXPECT_EQ(bad.status, 1);
  expect_contains(bad.text, "bad.jsonl:1: is no line of a trace");
}

TEST_F(Spidartrack, ARecordedTrackIsFoundBesideItsFilmAndFelt) {
  make_film("film.avi");
  ASSERT_EQ(spidartrack("record " + path("film.avi")).status, 0);
  std::ofstream(path("film.haptic.flac")) << "an older name, which may be that of film.mkv";
  GError* error = nullptr;
  GstElement* pipeline = gst_parse_launch(("filesrc location=" + path("film.avi") +
                                           " ! decodebin ! videoconvert ! spidarmotion name=motion "
                                           "track=auto ! fakesink")
                                              .c_str(),
                                          &error);
  ASSERT_EQ(error, nullptr) << error->message;
  GstElement* motion = gst_bin_get_by_name(GST_BIN(pipeline), "motion");
  gst_element_set_state(pipeline, GST_STATE_PLAYING);
  GstBus* bus = gst_element_get_bus(pipeline);
  GstMessage* message = gst_bus_timed_pop_filtered(
      bus, GST_CLOCK_TIME_NONE,
      static_cast<GstMessageType>(GST_MESSAGE_EOS | GST_MESSAGE_ERROR | GST_MESSAGE_WARNING));
  EXPECT_EQ(GST_MESSAGE_TYPE(message), GST_MESSAGE_EOS);
  gst_message_unref(message);
  GstStructure* stats = nullptr;
  g_object_get(motion, "stats", &stats, nullptr);
  guint64 analysed = 0, replayed = 0;
  EXPECT_TRUE(gst_structure_get(stats, "frames", G_TYPE_UINT64, &analysed, "track-frames",
                                G_TYPE_UINT64, &replayed, nullptr));
  EXPECT_EQ(analysed, 0u);
  EXPECT_EQ(replayed, 50u);
  gst_structure_free(stats);
  gst_element_set_state(pipeline, GST_STATE_NULL);
  gst_object_unref(bus);
  gst_object_unref(motion);
  gst_object_unref(pipeline);
}

TEST_F(Spidartrack, AnEditorChangesWhatItTouchesAndNothingElse) {
  save_track(path("a.wav"), samples());
  run_pipeline(
      "filesrc location=" + quoted(path("a.wav")) +
      " ! wavparse ! volume volume=0.5 ! wavenc ! filesink location=" + quoted(path("weaker.wav")));
  std::vector<TrackSample> half = samples();
  for (TrackSample& sample : half) {
    for (float& value : sample) value /= 2;
  }
  EXPECT_EQ(load_track(path("weaker.wav")), half) << "a half of a float is exact";

  if (std::system("ffmpeg -version > /dev/null 2>&1") != 0) {
    GTEST_SKIP() << "fades are not tested: ffmpeg is not installed";
  }
  const std::string fades = "afade=t=in:d=0.5,afade=t=out:st=1.5:d=0.5";
  ASSERT_EQ(std::system(("ffmpeg -v error -i " + path("a.wav") + " -af " + fades +
                         " -c:a pcm_f32le " + path("faded.wav"))
                            .c_str()),
            0);
  const std::vector<TrackSample> faded = load_track(path("faded.wav")), whole = samples();
  ASSERT_EQ(faded.size(), whole.size());
  for (size_t i = 0; i < whole.size(); ++i) {
    const double gain =
        std::min({1.0, static_cast<double>(i) / 500, (2000 - static_cast<double>(i)) / 500});
    for (size_t k = 0; k < kTrackChannels; ++k) {
      if (i >= 500 && i <= 1500) {
        ASSERT_EQ(faded[i][k], whole[i][k]) << i;
      }
      // Floats below 1.
      ASSERT_NEAR(faded[i][k], gain * whole[i][k], 1e-7) << i;
    }
  }
}

TEST_F(Spidartrack, AFunscriptHasMillisecondsAndPositions) {
  save_track(path("a.wav"), samples());
  ASSERT_EQ(spidartrack("convert --axis fz " + path("a.wav") + " " + path("a.funscript")).status,
            0);
  std::ifstream file(path("a.funscript"));
  const nlohmann::json script = nlohmann::json::parse(file);
  int last = -1;
  for (const nlohmann::json& action : script["actions"]) {
    const int at = action["at"];
    EXPECT_GT(at, last);
    last = at;
    const double share = samples()[static_cast<size_t>(at)][2];
    EXPECT_EQ(action["pos"], std::lround(50 + 50 * share));
  }
  EXPECT_EQ(last, 1999);
}

TEST_F(Spidartrack, APlotShowsStillsOfItsFilmAndOfNoOther) {
  if (std::system("gnuplot --version > /dev/null 2>&1") != 0) {
    GTEST_SKIP() << "gnuplot is not installed";
  }
  make_film("film.avi");  // two seconds, 4:3
  save_track(path("a.wav"), samples());
  const auto height = [](const std::string& png) {
    std::ifstream file(png, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    EXPECT_EQ(bytes.compare(1, 3, "PNG"), 0);
    return bytes.size() < 24 ? 0 : GST_READ_UINT32_BE(bytes.data() + 20);
  };
  ASSERT_EQ(spidartrack("plot " + path("a.wav") + " " + path("plain.png")).status, 0);
  const CommandResult plotted = spidartrack("plot " + path("a.wav") + " " + path("stills.png") +
                                            " --film " + path("film.avi"));
  ASSERT_EQ(plotted.status, 0) << plotted.text;
  // The stills are 160 pixels wide, and a gap of 14 is below them.
  EXPECT_EQ(height(path("stills.png")), height(path("plain.png")) + 120 + 14);

  std::vector<TrackSample> longer = samples();
  longer.resize(3000);
  save_track(path("longer.wav"), longer);
  const CommandResult other = spidartrack("plot " + path("longer.wav") + " " + path("no.png") +
                                          " --film " + path("film.avi"));
  EXPECT_EQ(other.status, 1);
  expect_contains(other.text, "another film: the track lasts 3.000 s, the film 2.000 s");
  const CommandResult none =
      spidartrack("plot " + path("a.wav") + " " + path("no.png") + " --film " + path("none.avi"));
  EXPECT_EQ(none.status, 1);
  expect_contains(none.text, "none.avi");
}

TEST_F(Spidartrack, CheckFindsWhatWouldNotBeFeltAsItIs) {
  save_track(path("good.wav"), samples());
  EXPECT_EQ(spidartrack("check " + path("good.wav")).status, 0);
  std::vector<TrackSample> bad = samples();
  bad[100][0] = std::numeric_limits<float>::quiet_NaN();
  for (size_t i = 500; i < 600; ++i) bad[i][1] = 1.5F;
  for (size_t i = 0; i < bad.size(); ++i) bad[i][3] = i % 4 < 2 ? 0.2F : -0.2F;
  save_track(path("bad.wav"), bad);
  const CommandResult result = spidartrack("check " + path("bad.wav"));
  EXPECT_EQ(result.status, 1);
  for (const char* problem : {"1 samples are not numbers", "100 samples are beyond full scale",
                              "largest force", "largest torque", "changes by", "energy of tx"}) {
    expect_contains(result.text, problem);
  }
  const nlohmann::json info =
      nlohmann::json::parse(spidartrack("info --json " + path("good.wav")).text);
  EXPECT_EQ(info["samples"], 2000);
  EXPECT_NEAR(info["channels"]["fz"]["peak"], 0.15, 1e-4);
}

TEST_F(Spidartrack, WhatIsDamagedOrNoTrackIsNamed) {
  save_track(path("a.flac"), samples());
  std::ofstream(path("text.flac")) << "no music";
  run_pipeline(
      "audiotestsrc num-buffers=10 ! audio/x-raw,rate=8000,channels=2 ! wavenc ! filesink "
      "location=" +
      quoted(path("stereo.wav")));
  EXPECT_EQ(spidartrack("info " + path("text.flac")).status, 1);
  const CommandResult stereo = spidartrack("info " + path("stereo.wav"));
  EXPECT_EQ(stereo.status, 1);
  expect_contains(stereo.text, "2 channels");
  // Cut in the middle: what is left is a track.
  fs::resize_file(path("a.flac"), fs::file_size(path("a.flac")) / 2);
  expect_contains(spidartrack("info " + path("a.flac")).text, "it is cut off: 0.");
  const CommandResult cut = spidartrack("check " + path("a.flac"));
  EXPECT_EQ(cut.status, 1);
  expect_contains(cut.text, "s of 2.000 s are there");
  save_track(path("b.flac"), samples());
  EXPECT_EQ(spidartrack("convert " + path("b.flac") + " " + path("b.wav")).status, 0);
  fs::resize_file(path("b.wav"), fs::file_size(path("b.wav")) / 2);
  const CommandResult half = spidartrack("check " + path("b.wav"));
  EXPECT_EQ(half.status, 1);
  expect_contains(half.text, "s of 2.000 s are there");
}

TEST_F(Spidartrack, APipelineThatNeverBeginsIsNotAwaitedForEver) {
  GstElement* pipeline =
      gst_parse_launch("fakesrc ! identity drop-probability=1 ! fakesink", nullptr);
  gst_element_set_state(pipeline, GST_STATE_PLAYING);
  EXPECT_THROW(await_message(pipeline, GST_MESSAGE_EOS, GST_CLOCK_TIME_NONE, 200 * GST_MSECOND),
               std::runtime_error);
  gst_element_set_state(pipeline, GST_STATE_NULL);
  gst_object_unref(pipeline);
}

}  // namespace
}  // namespace spidar::test::spidartrack_test
