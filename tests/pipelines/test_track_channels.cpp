// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Six constants, different on each channel, on the ways of docs/haptic-track.md from a file to the
// hand; test_track_conversion.py has those from one file to another and through containers, and
// test_track_network.cpp those over a network.
#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include <gst/gst.h>
#include <gtest/gtest.h>

#include "core/track/track_format.h"
#include "plugin/tools/track_samples.h"
#include "tests/pipelines/felt_trace.h"
#include "tests/pipelines/track_command.h"
#include "tests/support/temporary_folder.h"

namespace spidar::test::track_channels_test {
namespace {

constexpr int kFrames = 10;
constexpr int kSamples = 400;  // as long as the film at 25 frames/s

const std::string kVideo = "videotestsrc pattern=ball num-buffers=" + std::to_string(kFrames) +
                           " ! video/x-raw,width=64,height=48,framerate=25/1 ! ";
/// kConstant in a track of its own: names of the files that SetUp() makes.
const std::vector<std::string> kTracks = {"track.wav", "track.flac", "f32.mka", "flac.mka",
                                          "s24.mov",   "f64be.mov",  "alac.mov"};

class TrackChannels : public testing::Test {
 protected:
  static void SetUpTestSuite() { gst_init(nullptr, nullptr); }
  void SetUp() override {
    save_track(path("track.wav"), constant());
    save_track(path("track.flac"), constant());
    save_track(path("f32.mka"), constant());
    const std::string read = "filesrc location=" + quoted(path("track.flac")) + " ! flacparse ! ";
    const std::string write = " ! filesink location=";
    run_pipeline(read + "matroskamux" + write + quoted(path("flac.mka")));
    run_pipeline(
        read +
        "flacdec ! capssetter caps=\"audio/x-raw,channel-mask=(bitmask)0x0\" ! "
        "audioconvert dithering=none noise-shaping=none ! audio/x-raw,format=S24LE ! qtmux" +
        write + quoted(path("s24.mov")));
    // The decoder of ALAC gives channel after channel, and the other file has numbers whose first
    // byte is the largest.
    for (const char* codec : {"alac", "pcm_f64be"}) {
      const std::string name = std::strchr(codec, '_') ? "f64be.mov" : "alac.mov";
      ASSERT_EQ(run("ffmpeg -nostdin -v error -i " + path("track.flac") + " -c:a " + codec + " " +
                    path(name))
                    .text,
                "");
    }
    run_pipeline("avimux name=mux" + write + quoted(path("sound.avi")) + " " + kVideo +
                 "jpegenc ! mux. audiotestsrc num-buffers=20 samplesperbuffer=960 ! "
                 "audio/x-raw,format=S16LE,rate=48000,channels=2 ! mux.");
  }

  std::string path(const std::string& name) const { return (folder.path / name).string(); }
  static std::vector<TrackSample> constant() {
    return std::vector<TrackSample>(kSamples, kConstant);
  }
  /// Plays what ends with an element that writes the trace. In real time, but nothing depends on
  /// it: ticks that come late leave samples out, and none is wrong.
  void expect_felt(const std::string& line) const {
    SCOPED_TRACE(line);
    GError* error = nullptr;
    GstElement* pipeline = gst_parse_launch(line.c_str(), &error);
    ASSERT_EQ(error, nullptr) << error->message;
    const Outcome outcome = await_end(pipeline);
    gst_element_set_state(pipeline, GST_STATE_NULL);
    gst_object_unref(pipeline);
    EXPECT_TRUE(outcome.eos) << outcome.error;
    EXPECT_TRUE(outcome.warnings.empty()) << outcome.warnings.front();
    const std::vector<Row> rows = felt_constant(path("trace.csv"));
    EXPECT_TRUE(std::any_of(rows.begin(), rows.end(), [](const Row& row) {
      return row.interpolated;
    })) << "something was felt";
  }
  std::string trace() const { return " haptic-trace=" + quoted(path("trace.csv")); }

  TemporaryFolder folder;
};

TEST_F(TrackChannels, OfEveryContainerIntoTheSink) {
  for (const std::string& track : kTracks) {
    expect_felt("filesrc location=" + quoted(path(track)) + " ! decodebin ! spidarsink" + trace());
  }
}

TEST_F(TrackChannels, OfEveryContainerInPlaceOfAnalysis) {
  for (const std::string& track : kTracks) {
    expect_felt(kVideo + "spidarmotion track=" + quoted(path(track)) + trace() +
                " ! fakesink sync=true");
  }
}

TEST_F(TrackChannels, OfTheTrackBesideTheFilmAndOfTheOneInIt) {
  ASSERT_EQ(run("ffmpeg -nostdin -v error -i " + path("sound.avi") + " -i " + path("alac.mov") +
                " -map 0 -map 1 -c copy " + path("felt.mov"))
                .text,
            "");
  for (const char* end : {".flac", ".mka", ".wav"}) {
    save_track(path("sound.haptic") + end, constant());
    expect_felt("filesrc location=" + quoted(path("sound.avi")) +
                " ! avidemux ! jpegdec ! videoconvert ! spidarmotion track=auto" + trace() +
                " ! fakesink sync=true");
    std::filesystem::remove(path("sound.haptic") + end);
  }
  expect_felt(kVideo + "spidarmotion track=" + quoted(path("felt.mov")) + trace() +
              " ! fakesink sync=true");
  expect_felt("filesrc location=" + quoted(path("felt.mov")) +
              " ! qtdemux ! jpegdec ! videoconvert ! spidarmotion track=auto" + trace() +
              " ! fakesink sync=true");
}

}  // namespace
}  // namespace spidar::test::track_channels_test
