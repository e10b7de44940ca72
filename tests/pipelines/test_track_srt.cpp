// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// A haptic track over SRT, as docs/haptic-track.md sends it, and what is felt when the link is
// lost. In real time; nothing here depends on how long anything takes.
#include <algorithm>
#include <string>

#include <gst/gst.h>
#include <gtest/gtest.h>

#include "tests/pipelines/cut_link.h"
#include "tests/pipelines/track_network.h"

namespace spidar::test::track_srt_test {
namespace {

class TrackSrt : public TrackNetwork {
 protected:
  void SetUp() override {
    const std::string absent = missing({"srtsrc", "srtsink"});
    if (!absent.empty()) GTEST_SKIP() << absent;
    TrackNetwork::SetUp();
  }

  GstElement* sender(int port) const {
    return parse(track() +
                 " ! flacparse ! flacdec ! rtpgstpay config-interval=1 mtu=1316 ! srtsink "
                 "uri=\"srt://127.0.0.1:" +
                 std::to_string(port) + "?mode=listener\"");
  }
  GstElement* receiver(int port) const {
    return parse("srtsrc latency=200 uri=srt://127.0.0.1:" + std::to_string(port) +
                 " ! application/"
                 "x-rtp,media=application,clock-rate=90000,encoding-name=X-GST,payload=96 ! "
                 "rtpjitterbuffer latency=50 ! rtpgstdepay ! " +
                 sink());
  }
  static void await_samples(GstElement* receiver, guint64 count) {
    while (samples_of(receiver) < count) g_usleep(10'000);
  }
  static void await_silence(GstElement* receiver) {
    for (guint64 before = 0, now = samples_of(receiver); now != before || now == 0;) {
      before = now;
      g_usleep(1'000'000);  // more than what waits in the buffers
      now = samples_of(receiver);
    }
  }
};

TEST_F(TrackSrt, ALinkThatIsCutIsARampToRestAndBack) {
  const int port = free_port();
  CutLink link(port);
  GstElement* sending = sender(port);
  GstElement* feeling = receiver(link.port());
  gst_element_set_state(sending, GST_STATE_PLAYING);
  gst_element_set_state(feeling, GST_STATE_PLAYING);
  await_samples(feeling, 400);
  link.cut(true);
  g_usleep(1'000'000);
  link.cut(false);
  await_silence(feeling);
  stop(feeling);
  stop(sending);
  expect_rest_between();
}

TEST_F(TrackSrt, ASenderThatIsStartedAgainIsFeltAgain) {
  const int port = free_port();
  GstElement* first = sender(port);
  GstElement* feeling = receiver(port);
  gst_element_set_state(first, GST_STATE_PLAYING);
  gst_element_set_state(feeling, GST_STATE_PLAYING);
  await_samples(feeling, 400);
  stop(first);
  g_usleep(300'000);  // at rest by then
  const guint64 before = samples_of(feeling);
  GstElement* second = sender(port);
  gst_element_set_state(second, GST_STATE_PLAYING);
  await_samples(feeling, before + 400);
  await_silence(feeling);
  stop(feeling);
  stop(second);
  expect_rest_between();
}

}  // namespace
}  // namespace spidar::test::track_srt_test
