// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// spidardepth: ends, flushes, missing timestamps, latency, and invalid settings.
#include <string>
#include <thread>
#include <vector>

#include "depth_harness.h"

namespace spidar::test::depth_interruptions_test {
namespace {

class DepthInterruptions : public DepthHarness {};

TEST_F(DepthInterruptions, WhenTheVideoEndsTheDepthDoesToo) {
  push_depth(0, kFrame, 1000);
  push_video(3);
  gst_harness_push_event(video, gst_event_new_eos());
  depth_thread.join();
  EXPECT_EQ(depth_flow, GST_FLOW_EOS);
  EXPECT_EQ(next_message(GST_MESSAGE_WARNING), "");
}

TEST_F(DepthInterruptions, WarnsWhenNoFrameEverGotDepth) {
  push_depth(100 * kFrame, kFrame, 2);
  push_video(3);
  gst_harness_push_event(video, gst_event_new_eos());
  EXPECT_NE(next_message(GST_MESSAGE_WARNING).find("none at the time of any frame"),
            std::string::npos);
}

TEST_F(DepthInterruptions, DepthWithoutTimestampsIsDroppedWithAWarning) {
  push_depth({depth_image(GST_CLOCK_TIME_NONE), depth_image(GST_CLOCK_TIME_NONE)});
  push_video(2);
  for (const Shown& one : shown()) EXPECT_FALSE(one.has_depth);
  EXPECT_NE(next_message(GST_MESSAGE_WARNING).find("without timestamps"), std::string::npos);
  EXPECT_EQ(next_message(GST_MESSAGE_WARNING), "") << "once";
}

TEST_F(DepthInterruptions, FramesWithoutTimestampsPass) {
  push_depth(0, kFrame, 2);
  ASSERT_EQ(gst_harness_push(video, video_frame(GST_CLOCK_TIME_NONE)), GST_FLOW_OK);
  const std::vector<Shown> all = shown();
  ASSERT_EQ(all.size(), 1u);
  EXPECT_FALSE(all[0].has_depth);
}

TEST_F(DepthInterruptions, AGapOfTheDepthLetsTheVideoGoOn) {
  push_depth({depth_image(0)}, false);
  push_video(1);
  depth_thread.join();
  gst_harness_push_event(depth, gst_event_new_gap(kFrame, 10 * kFrame));
  for (GstClockTime n = 1; n < 10; ++n) {
    ASSERT_EQ(gst_harness_push(video, video_frame(n * kFrame)), GST_FLOW_OK);
  }
  EXPECT_EQ(shown().size(), 10u);
}

TEST_F(DepthInterruptions, AFlushOfTheVideoReleasesAFrameThatWaits) {
  GstFlowReturn flow = GST_FLOW_OK;
  video_thread = std::thread([&] { flow = gst_harness_push(video, video_frame(0)); });
  // It ends whether or not it is waiting already.
  gst_harness_push_event(video, gst_event_new_flush_start());
  video_thread.join();
  EXPECT_EQ(flow, GST_FLOW_FLUSHING);
  gst_harness_push_event(video, gst_event_new_flush_stop(TRUE));
  gst_harness_push_event(depth, gst_event_new_eos());
  GstSegment segment;
  gst_segment_init(&segment, GST_FORMAT_TIME);
  gst_harness_push_event(video, gst_event_new_segment(&segment));
  EXPECT_EQ(gst_harness_push(video, video_frame(0)), GST_FLOW_OK);
}

TEST_F(DepthInterruptions, AFlushOfTheDepthForgetsWhatHasCome) {
  push_depth({depth_image(0), depth_image(kFrame), depth_image(2 * kFrame)}, false);
  push_video(1);
  gst_harness_push_event(depth, gst_event_new_flush_start());
  depth_thread.join();
  EXPECT_EQ(depth_flow, GST_FLOW_FLUSHING);
  gst_harness_push_event(depth, gst_event_new_flush_stop(TRUE));
  GstSegment segment;
  gst_segment_init(&segment, GST_FORMAT_TIME);
  gst_harness_push_event(depth, gst_event_new_segment(&segment));
  push_depth({depth_image(2 * kFrame)});
  for (const GstClockTime n : {GstClockTime{1}, GstClockTime{2}}) {
    ASSERT_EQ(gst_harness_push(video, video_frame(n * kFrame)), GST_FLOW_OK);
  }
  const std::vector<Shown> all = shown();
  ASSERT_EQ(all.size(), 3u);
  EXPECT_TRUE(all[0].has_depth);
  EXPECT_FALSE(all[1].has_depth);
  EXPECT_TRUE(all[2].has_depth);
}

TEST_F(DepthInterruptions, StoppingReleasesBoth) {
  push_depth({depth_image(0), depth_image(kFrame), depth_image(2 * kFrame)}, false);
  video_thread = std::thread([this] {
    // The last two wait for depth that never comes.
    for (GstClockTime n = 0; n < 5; ++n) gst_harness_push(video, video_frame(n * kFrame));
  });
  close();  // ends
}

TEST_F(DepthInterruptions, ReportsTheLatencyOfTheSlowerBranch) {
  set_live(true);
  gst_harness_set_upstream_latency(video, 7 * GST_MSECOND);
  gst_harness_set_upstream_latency(depth, 30 * GST_MSECOND);
  EXPECT_EQ(gst_harness_query_latency(video), 30 * GST_MSECOND);
  gst_harness_set_upstream_latency(depth, 3 * GST_MSECOND);
  EXPECT_EQ(gst_harness_query_latency(video), 7 * GST_MSECOND);
  gst_harness_set_live(depth, FALSE);
  gst_harness_set_upstream_latency(depth, 100 * GST_MSECOND);
  EXPECT_EQ(gst_harness_query_latency(video), 7 * GST_MSECOND) << "what is not live has none";
}

TEST_F(DepthInterruptions, LiveAFrameWaitsNoLongerThanThatLatency) {
  set_live(true);
  gst_harness_use_testclock(video);
  gst_harness_set_upstream_latency(video, 7 * GST_MSECOND);
  gst_harness_set_upstream_latency(depth, 30 * GST_MSECOND);
  GstTestClock* clock = gst_harness_get_testclock(video);
  gst_harness_push(depth, depth_image(0));
  push_video(1);
  EXPECT_EQ(gst_clock_get_time(GST_CLOCK(clock)), 0u) << "its depth was there";
  video_thread = std::thread([this] { gst_harness_push(video, video_frame(kFrame)); });
  ASSERT_TRUE(gst_harness_wait_for_clock_id_waits(video, 1, 60));
  ASSERT_TRUE(gst_harness_crank_single_clock_wait(video));
  video_thread.join();
  EXPECT_EQ(gst_clock_get_time(GST_CLOCK(clock)), kFrame + 30 * GST_MSECOND);
  gst_object_unref(clock);
  const std::vector<Shown> all = shown();
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[1].first_sample, 0) << "the one before is young enough";
}

TEST_F(DepthInterruptions, NearAndFarAreOnTheMeta) {
  open("samples=disparity near=4000 far=100");
  push_depth(0, kFrame, 1);
  push_video(1);
  const std::vector<Shown> all = shown();
  ASSERT_EQ(all.size(), 1u);
  EXPECT_TRUE(all[0].depth.disparity);
  EXPECT_EQ(all[0].depth.near_sample, 4000);
  EXPECT_EQ(all[0].depth.far_sample, 100);
}

TEST_F(DepthInterruptions, NearBehindFarIsAnError) {
  open("near=4000 far=400");
  const std::string text = next_message(GST_MESSAGE_ERROR);
  EXPECT_NE(text.find("'near' must be less than 'far', but near is 4000 and far is 400"),
            std::string::npos)
      << text;
  open("near=400 far=4000 samples=disparity");
  EXPECT_NE(next_message(GST_MESSAGE_ERROR).find("must be more than"), std::string::npos);
  open("near=4000 far=400 samples=disparity");
  EXPECT_EQ(next_message(GST_MESSAGE_ERROR), "");
}

}  // namespace
}  // namespace spidar::test::depth_interruptions_test
