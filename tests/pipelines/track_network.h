// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A haptic track of 3 s that one pipeline sends over the loopback interface and another one feels.
#pragma once

#include <fstream>
#include <netinet/in.h>
#include <string>
#include <sys/socket.h>
#include <unistd.h>
#include <vector>

#include <gst/gst.h>
#include <gtest/gtest.h>

#include "core/track/track_format.h"
#include "tests/pipelines/felt_trace.h"
#include "tests/pipelines/launched.h"
#include "tests/support/temporary_folder.h"

namespace spidar::test {

class TrackNetwork : public testing::Test {
 protected:
  static void SetUpTestSuite() { gst_init(nullptr, nullptr); }

  void SetUp() override {
    const std::vector<TrackSample> samples(3000, kConstant);
    std::ofstream(path("raw"), std::ios::binary)
        .write(reinterpret_cast<const char*>(samples.data()),
               static_cast<std::streamsize>(samples.size() * sizeof(TrackSample)));
    const Outcome outcome = launch(
        "filesrc location=" + path("raw") +
        " ! rawaudioparse use-sink-caps=false format=pcm pcm-format=f32le sample-rate=1000 "
        "num-channels=6 ! capssetter caps=\"audio/x-raw,channel-mask=(bitmask)0x3f\" ! "
        "audioconvert "
        "dithering=none noise-shaping=none ! audio/x-raw,format=S24_32LE ! flacenc blocksize=40 ! "
        "filesink location=" +
        path("film.haptic.flac"));
    ASSERT_TRUE(outcome.eos) << outcome.error;
  }

  std::string path(const std::string& name) const { return (folder.path / name).string(); }
  std::string track() const { return "filesrc location=" + path("film.haptic.flac"); }
  std::string sink() const { return "spidarsink name=sink haptic-trace=" + path("trace.csv"); }

  static GstElement* parse(const std::string& line) {
    GError* error = nullptr;
    GstElement* pipeline = gst_parse_launch(line.c_str(), &error);
    EXPECT_EQ(error, nullptr) << error->message;
    return pipeline;
  }
  static int number_of(GstElement* pipeline, const char* element, const char* property) {
    int value = 0;
    GstElement* of = gst_bin_get_by_name(GST_BIN(pipeline), element);
    g_object_get(of, property, &value, nullptr);
    gst_object_unref(of);
    return value;
  }
  static guint64 samples_of(GstElement* receiver) {
    GstElement* sink = gst_bin_get_by_name(GST_BIN(receiver), "sink");
    GstStructure* stats = nullptr;
    guint64 samples = 0;
    g_object_get(sink, "stats", &stats, nullptr);
    gst_structure_get_uint64(stats, "samples", &samples);
    gst_structure_free(stats);
    gst_object_unref(sink);
    return samples;
  }
  static void stop(GstElement* pipeline) {
    gst_element_set_state(pipeline, GST_STATE_NULL);
    gst_object_unref(pipeline);
  }
  /// Plays `sender` to its end, and ends `receiver` when nothing comes any more.
  static void play_both(GstElement* sender, GstElement* receiver) {
    const Outcome sent = await_end(sender);
    EXPECT_TRUE(sent.eos) << sent.error;
    for (guint64 before = 0, now = samples_of(receiver); now != before || now == 0;) {
      before = now;
      g_usleep(1'000'000);  // more than what waits in the jitter buffer
      now = samples_of(receiver);
    }
    stop(receiver);
    stop(sender);
  }
  /// A port of the loopback interface that no program uses.
  static int free_port() {
    const int socket_fd = socket(AF_INET, SOCK_DGRAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t length = sizeof address;
    EXPECT_EQ(bind(socket_fd, reinterpret_cast<sockaddr*>(&address), length), 0);
    EXPECT_EQ(getsockname(socket_fd, reinterpret_cast<sockaddr*>(&address), &length), 0);
    close(socket_fd);
    return ntohs(address.sin_port);
  }
  /// What is missing of some elements; empty: nothing.
  static std::string missing(const std::vector<const char*>& elements) {
    for (const char* element : elements) {
      GstElementFactory* factory = gst_element_factory_find(element);
      if (!factory) return std::string(element) + " (gstreamer1.0-plugins-bad) is not installed";
      gst_object_unref(factory);
    }
    return {};
  }
  std::vector<Row> felt() const { return felt_constant(path("trace.csv")); }
  /// All of the force was felt, then there was rest, then all of it again.
  void expect_rest_between() const {
    const double full_N = to_wrench(kConstant).force_N.norm();
    enum { kBefore, kFelt, kRest, kAgain } seen = kBefore;
    for (const Row& row : felt()) {
      const double force_N = row.commanded_N();
      if (seen == kBefore && force_N > 0.99 * full_N) seen = kFelt;
      if (seen == kFelt && force_N == 0) seen = kRest;
      if (seen == kRest && force_N > 0.99 * full_N) seen = kAgain;
    }
    EXPECT_EQ(seen, kAgain) << "felt, at rest, and felt again";
  }

  TemporaryFolder folder;
};

}  // namespace spidar::test
