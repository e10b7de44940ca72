// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Haptic tracks over the network, sent as in docs/haptic-track.md, on the loopback interface. In
// real time, but independent of durations.
#include <algorithm>
#include <fstream>
#include <iterator>
#include <string>

#include <gst/gst.h>
#include <gtest/gtest.h>

#include "tests/pipelines/track_network.h"

namespace spidar::test::track_network_test {
namespace {

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

  expect_rest_between();
}

TEST_F(TrackNetwork, AnSdpFileLeadsToTheTrack) {
  const std::string absent = missing({"sdpdemux"});
  if (!absent.empty()) GTEST_SKIP() << absent;
  const int port = free_port();
  // That of the page, with a port of this test.
  std::ifstream shipped(SDP_FILE);
  std::string text{std::istreambuf_iterator<char>(shipped), {}};
  const std::string of_page = " 5004 ";
  ASSERT_NE(text.find(of_page), std::string::npos) << SDP_FILE;
  text.replace(text.find(of_page), of_page.size(), " " + std::to_string(port) + " ");
  std::ofstream(path("haptic.sdp")) << text;
  GstElement* receiver = parse("filesrc location=" + path("haptic.sdp") +
                               " ! sdpdemux latency=200 ! rtpgstdepay ! " + sink());
  gst_element_set_state(receiver, GST_STATE_PLAYING);
  play_both(parse(track() +
                  " ! flacparse ! flacdec ! rtpgstpay config-interval=1 ! udpsink host=127.0.0.1 "
                  "port=" +
                  std::to_string(port)),
            receiver);
  const double full_N = to_wrench(kConstant).force_N.norm();
  double largest_N = 0;
  for (const Row& row : felt()) largest_N = std::max(largest_N, row.commanded_N());
  EXPECT_NEAR(largest_N, full_N, 1e-6);
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
}  // namespace spidar::test::track_network_test
