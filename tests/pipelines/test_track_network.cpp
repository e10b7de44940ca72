// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Haptic tracks over the network, as docs/haptic-track.md sends them, on the loopback interface. In
// real time; nothing here depends on how long anything takes.
#include <algorithm>
#include <fstream>
#include <string>
#include <vector>

#include <gst/gst.h>
#include <gtest/gtest.h>

#include "core/track/track_format.h"
#include "tests/pipelines/felt_trace.h"
#include "tests/pipelines/launched.h"
#include "tests/support/temporary_folder.h"

namespace spidar::test {
namespace {

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
  std::vector<Row> felt() const { return felt_constant(path("trace.csv")); }

  TemporaryFolder folder;
};

/// A second of packets arrives but for three, then none for 0.8 s, then all.
bool is_lost(int packet) {
  return packet == 10 || packet == 15 || packet == 16 || (packet >= 25 && packet < 45);
}

/// The payloader pushes each packet as a list of one.
GstPadProbeReturn lose(GstPad*, GstPadProbeInfo*, gpointer user) {
  int& packet = *static_cast<int*>(user);
  return is_lost(packet++) ? GST_PAD_PROBE_DROP : GST_PAD_PROBE_OK;
}

TEST_F(TrackNetwork, LostPacketsAreARampToRestAndBack) {
  GstElement* receiver = parse(
      "udpsrc name=source address=127.0.0.1 port=0 "
      "caps=\"application/"
      "x-rtp,media=application,clock-rate=90000,encoding-name=X-GST,payload=96\" ! "
      "rtpjitterbuffer latency=200 ! rtpgstdepay ! " +
      sink());
  gst_element_set_state(receiver, GST_STATE_READY);
  GstElement* source = gst_bin_get_by_name(GST_BIN(receiver), "source");
  gst_element_set_state(source, GST_STATE_READY);
  gst_object_unref(source);
  gst_element_set_state(receiver, GST_STATE_PLAYING);
  const int port = number_of(receiver, "source", "port");
  ASSERT_GT(port, 0);
  GstElement* sender =
      parse(track() +
            " ! flacparse ! flacdec ! rtpgstpay name=pay config-interval=1 ! udpsink "
            "host=127.0.0.1 port=" +
            std::to_string(port));
  GstElement* pay = gst_bin_get_by_name(GST_BIN(sender), "pay");
  GstPad* pad = gst_element_get_static_pad(pay, "src");
  int packets = 0;
  gst_pad_add_probe(
      pad, static_cast<GstPadProbeType>(GST_PAD_PROBE_TYPE_BUFFER | GST_PAD_PROBE_TYPE_BUFFER_LIST),
      lose, &packets, nullptr);
  gst_object_unref(pad);
  gst_object_unref(pay);
  play_both(sender, receiver);
  EXPECT_GE(packets, 75) << "one for each 40 ms";

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

TEST_F(TrackNetwork, MatroskaOverTcpIsFelt) {
  GstElement* sender = parse(
      track() +
      " ! flacparse ! matroskamux streamable=true min-cluster-duration=0 "
      "max-cluster-duration=100000000 ! tcpserversink name=server host=127.0.0.1 port=0 sync=true "
      "sync-method=next-keyframe");
  gst_element_set_state(sender, GST_STATE_PAUSED);
  gst_element_get_state(sender, nullptr, nullptr, GST_CLOCK_TIME_NONE);
  GstElement* receiver =
      parse("tcpclientsrc host=127.0.0.1 port=" +
            std::to_string(number_of(sender, "server", "current-port")) +
            " ! matroskademux ! flacparse ! flacdec ! " + sink() + " ts-offset=200000000");
  gst_element_set_state(receiver, GST_STATE_PLAYING);
  // So that all of the track is there to be received, however slow this is.
  while (number_of(sender, "server", "num-handles") == 0) g_usleep(10'000);
  await_end(sender);
  stop(sender);
  const Outcome outcome = await_end(receiver);
  stop(receiver);
  EXPECT_TRUE(outcome.eos) << outcome.error;
  EXPECT_TRUE(outcome.warnings.empty());
  const double full_N = to_wrench(kConstant).force_N.norm();
  double largest_N = 0;
  for (const Row& row : felt()) largest_N = std::max(largest_N, row.commanded_N());
  EXPECT_NEAR(largest_N, full_N, 1e-6);
}

}  // namespace
}  // namespace spidar::test
