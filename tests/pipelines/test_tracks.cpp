// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Haptic tracks through files, with the plugin as GStreamer loads it.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gst/app/gstappsink.h>
#include <gst/gst.h>
#include <gtest/gtest.h>

#include "core/track/track_format.h"
#include "tests/pipelines/launched.h"
#include "tests/support/temporary_folder.h"

namespace spidar::test::tracks_test {
namespace {

constexpr const char* kFilm =
    "videotestsrc num-buffers=125 pattern=ball ! video/x-raw,width=320,height=240,framerate=25/1 "
    "! ";
constexpr const char* kAnalyse = "spidarmotion attach-meta=true ";
constexpr const char* kNoDither = "audioconvert dithering=none noise-shaping=none ! ";

/// All samples that a launch line ends with, as floats.
std::vector<TrackSample> samples_of(const std::string& line) {
  std::vector<TrackSample> samples;
  GError* error = nullptr;
  GstElement* pipeline = gst_parse_launch(
      (line + kNoDither + "audio/x-raw,format=F32LE ! appsink name=out sync=false").c_str(),
      &error);
  EXPECT_EQ(error, nullptr) << (error ? error->message : "");
  g_clear_error(&error);
  if (!pipeline) return samples;
  GstElement* sink = gst_bin_get_by_name(GST_BIN(pipeline), "out");
  gst_element_set_state(pipeline, GST_STATE_PLAYING);
  while (GstSample* pulled = gst_app_sink_pull_sample(GST_APP_SINK(sink))) {
    GstBuffer* buffer = gst_sample_get_buffer(pulled);
    GstMapInfo map;
    gst_buffer_map(buffer, &map, GST_MAP_READ);
    EXPECT_EQ(GST_BUFFER_PTS(buffer), samples.size() * kTrackPeriod_ns);
    const size_t before = samples.size();
    samples.resize(before + map.size / sizeof(TrackSample));
    std::memcpy(samples.data() + before, map.data, map.size);
    gst_buffer_unmap(buffer, &map);
    gst_sample_unref(pulled);
  }
  gst_element_set_state(pipeline, GST_STATE_NULL);
  gst_object_unref(sink);
  gst_object_unref(pipeline);
  return samples;
}

float largest_difference(const std::vector<TrackSample>& a, const std::vector<TrackSample>& b) {
  float largest = 0;
  for (size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    for (size_t k = 0; k < kTrackChannels; ++k)
      largest = std::max(largest, std::fabs(a[i][k] - b[i][k]));
  }
  return largest;
}

struct Container {
  std::string name, writer, reader;
  float error;  // of its encoding
};

std::vector<Container> containers() {
  // 24 bits: half a step, and what a float below 1 is rounded by.
  const float half_step_24 = std::ldexp(1.0F, -24) + std::ldexp(1.0F, -25);
  const std::string s24 = std::string(kNoDither) + "audio/x-raw,format=S24LE ! ";
  return {
      {"f32.mka", "matroskamux ! ", "matroskademux ! ", 0},
      {"f32.wav", "wavenc ! ", "wavparse ! ", 0},
      {"s24.flac", std::string(kNoDither) + "flacenc blocksize=40 ! ", "flacparse ! flacdec ! ",
       half_step_24},
      {"flac.mka", std::string(kNoDither) + "flacenc blocksize=40 ! matroskamux ! ",
       "matroskademux ! flacparse ! flacdec ! ", half_step_24},
      {"s24.mov", "audio/x-raw,channel-mask=(bitmask)0 ! " + s24 + "qtmux ! ", "qtdemux ! ",
       half_step_24},
  };
}

class Tracks : public testing::Test {
 protected:
  static void SetUpTestSuite() { gst_init(nullptr, nullptr); }
  TemporaryFolder folder;
};

TEST_F(Tracks, FilesGiveBackWhatWasExtracted) {
  const std::string extract = std::string(kFilm) + kAnalyse + "! spidarextract name=x x.wrench ! ";
  const std::vector<TrackSample> live = samples_of(extract);
  ASSERT_EQ(live.size(), 5000u);
  ASSERT_GT(largest_difference(live, std::vector<TrackSample>(live.size())), 0.1F);
  for (const Container& container : containers()) {
    SCOPED_TRACE(container.name);
    const std::string path = (folder.path / container.name).string();
    const Outcome outcome = launch(extract + container.writer + "filesink location=" + path);
    ASSERT_TRUE(outcome.eos) << outcome.error;
    const std::vector<TrackSample> read =
        samples_of("filesrc location=" + path + " ! " + container.reader);
    ASSERT_EQ(read.size(), live.size());
    EXPECT_LE(largest_difference(read, live), container.error);
  }
}

TEST_F(Tracks, EveryChannelStaysInItsPlace) {
  const std::vector<TrackSample> constant(1000, {0.1F, -0.2F, 0.3F, -0.4F, 0.5F, -0.6F});
  const std::string raw = (folder.path / "raw").string();
  std::ofstream(raw, std::ios::binary)
      .write(reinterpret_cast<const char*>(constant.data()),
             static_cast<std::streamsize>(constant.size() * sizeof(TrackSample)));
  const std::string source =
      "filesrc location=" + raw +
      " ! rawaudioparse use-sink-caps=false format=pcm pcm-format=f32le sample-rate=1000 "
      "num-channels=6 ! capssetter caps=\"audio/x-raw,channel-mask=(bitmask)";
  for (const Container& container : containers()) {
    SCOPED_TRACE(container.name);
    const std::string path = (folder.path / container.name).string();
    const std::string mask = container.name == "s24.mov" ? "0x0" : "0x3f";
    const Outcome outcome =
        launch(source + mask + "\" ! " + container.writer + "filesink location=" + path);
    ASSERT_TRUE(outcome.eos) << outcome.error;
    const std::vector<TrackSample> read =
        samples_of("filesrc location=" + path + " ! " + container.reader);
    ASSERT_EQ(read.size(), constant.size());
    EXPECT_LE(largest_difference(read, constant), container.error);
  }
}

TEST_F(Tracks, TheForceIsThatOfTheTraceAtEveryFrame) {
  const std::string trace = (folder.path / "trace.csv").string();
  const std::vector<TrackSample> samples = samples_of(
      std::string(kFilm) + kAnalyse + "trace=" + trace + " ! spidarextract name=x x.wrench ! ");
  std::ifstream file(trace);
  std::string row;
  std::getline(file, row);
  int frames = 0;
  while (std::getline(file, row)) {
    std::vector<double> fields;
    std::istringstream cells(row);
    for (std::string cell; fields.size() < 12 && std::getline(cells, cell, ',');) {
      fields.push_back(std::stod(cell));  // up to the last column, which is a word
    }
    ASSERT_EQ(fields.size(), 12u);
    const auto ms = static_cast<size_t>(fields[0] / 1e6);
    ASSERT_LT(ms, samples.size());
    const Wrench recorded = to_wrench(samples[ms]);
    for (int axis = 0; axis < 6; ++axis) {
      ASSERT_NEAR(recorded.stacked()[axis], fields[static_cast<size_t>(6 + axis)], 1e-6) << row;
    }
    ++frames;
  }
  EXPECT_EQ(frames, 125);
}

TEST_F(Tracks, VideoAndTrackPlayTogether) {
  const Outcome outcome =
      launch(std::string("videotestsrc num-buffers=25 pattern=ball ! "
                         "video/x-raw,width=320,height=240,framerate=25/1 ! ") +
             kAnalyse +
             "! spidarextract name=x ! queue ! fakesink sync=true x.wrench ! queue ! fakesink "
             "sync=true");
  EXPECT_TRUE(outcome.eos) << outcome.error;
  EXPECT_TRUE(outcome.warnings.empty());
}

}  // namespace
}  // namespace spidar::test::tracks_test
