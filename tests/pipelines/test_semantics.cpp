// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Operations on a player and properties of streams: the force is that of the shown motion, at the
// time when it is shown. On a test clock; TickWatch also checks every tick.
#include <future>

#include "tests/pipelines/shown_motion.h"
#include "tests/support/test.h"

namespace spidar::test::semantics_test {
namespace {

/// A loop of 6 frames: shown, to its end.
void play_segment(SteppedPipeline& pipeline) {
  const std::vector<Eigen::Vector3d> felt_px_s = play(pipeline, 6);
  EXPECT_EQ(felt_px_s[0].norm(), 0) << "the jump is no motion";
  for (size_t n = 1; n < 6; ++n) EXPECT_GT(felt_px_s[n].norm(), kMoves_px_s) << n;
}

TEST(Semantics, SegmentSeeksLoopWithoutAGap) {
  SteppedPipeline pipeline(kPlayer);
  pipeline.set_state(GST_STATE_PAUSED);
  pipeline.seek(1.0, GST_SEEK_FLAG_FLUSH | GST_SEEK_FLAG_SEGMENT, 0, 6 * kFrame);
  pipeline.set_state(GST_STATE_PLAYING);
  for (GstClockTime pass = 0; pass < 3; ++pass) {
    SCOPED_TRACE(pass);
    pipeline.await_message(GST_MESSAGE_SEGMENT_DONE);
    pipeline.seek(1.0, GST_SEEK_FLAG_SEGMENT, 0, 6 * kFrame);
    play_segment(pipeline);
    EXPECT_EQ(pipeline.running_time(), (6 * pass + 5) * kFrame);
  }
}

TEST(Semantics, ASeekThatDoesNotFlushIsShownAfterWhatWasQueued) {
  SteppedPipeline pipeline(kPlayer);
  pipeline.set_state(GST_STATE_PAUSED);
  // The source pauses after 15 frames: one that waits for a full queue cannot be asked to seek.
  pipeline.seek(1.0, GST_SEEK_FLAG_FLUSH | GST_SEEK_FLAG_SEGMENT, 0, 15 * kFrame);
  pipeline.set_state(GST_STATE_PLAYING);
  play(pipeline, 5);
  pipeline.await_message(GST_MESSAGE_SEGMENT_DONE);
  pipeline.seek(1.0, GST_SEEK_FLAG_NONE, GST_SECOND, 2 * GST_SECOND);
  const std::vector<Eigen::Vector3d> felt_px_s = play(pipeline, 20);
  EXPECT_EQ(pipeline.running_time(), 24 * kFrame);
  for (size_t n = 0; n < 20; ++n) {
    // Frame 15 is the first after the jump, which is no motion.
    EXPECT_EQ(felt_px_s[n].norm() > kMoves_px_s, n != 10) << n;
  }
}

TEST(Semantics, ForceIsThatOfTheSpeedShown) {
  SteppedPipeline normal(kPlayer);
  normal.set_state(GST_STATE_PLAYING);
  const std::vector<Eigen::Vector3d> usual_px_s = play(normal, 10);
  for (const double rate : {0.25, 0.5, 4.0}) {
    SCOPED_TRACE(rate);
    SteppedPipeline pipeline(kPlayer);
    pipeline.set_state(GST_STATE_PAUSED);
    pipeline.seek(rate, GST_SEEK_FLAG_FLUSH, 0, GST_SECOND);
    pipeline.set_state(GST_STATE_PLAYING);
    const std::vector<Eigen::Vector3d> felt_px_s = play(pipeline, 10);
    EXPECT_EQ(pipeline.running_time(),
              static_cast<GstClockTime>(9 * static_cast<double>(kFrame) / rate));
    for (size_t n = 1; n < 10; ++n) {
      EXPECT_LT((felt_px_s[n] - rate * usual_px_s[n]).norm(), rate * kTolerance_px_s) << n;
      EXPECT_GT(felt_px_s[n].norm(), kMoves_px_s) << n;
    }
  }
}

TEST(Semantics, AnInstantChangeOfTheRateIsInTimeAndAsFast) {
  SteppedPipeline normal(kPlayer);
  normal.set_state(GST_STATE_PLAYING);
  const std::vector<Eigen::Vector3d> usual_px_s = play(normal, 50);

  SteppedPipeline pipeline(kPlayer);
  pipeline.set_state(GST_STATE_PLAYING);
  play(pipeline, 5);
  GstElement* source = gst_bin_get_by_name(GST_BIN(pipeline.pipeline()), "source");
  GstPad* pad = gst_element_get_static_pad(source, "src");
  // What a demuxer makes of such a seek. Twice as fast from the time of frame 4 on.
  const GstClockTime change = pipeline.running_time();
  ASSERT_EQ(change, 4 * kFrame);
  EXPECT_TRUE(gst_pad_push_event(pad, gst_event_new_instant_rate_change(2, GST_SEGMENT_FLAG_NONE)));
  gst_object_unref(pad);
  gst_object_unref(source);
  for (int n = 0; n < 3; ++n) pipeline.step();  // the sink may wait for an old time already
  for (size_t n = 0; n < 45; ++n) {
    const TickRecord tick = pipeline.step();
    const GstClockTime upstream = change + 2 * (pipeline.running_time() - change);
    SCOPED_TRACE(upstream);
    expect_wrench_of(pipeline, tick, upstream);
    const size_t frame = upstream / kFrame;
    // What waited in the queue, a second at most, was analysed at the old rate.
    if (frame < 35 || frame >= 50) continue;
    const Eigen::Vector3d felt_px_s = velocity_px_s(tick.wanted.force_N);
    EXPECT_LT((felt_px_s - 2 * usual_px_s[frame]).norm(), 2 * kTolerance_px_s);
    EXPECT_GT(felt_px_s.norm(), 2 * kMoves_px_s);
  }
}

TEST(Semantics, TimestampsThatJumpBackAreFeltAgainWhenTheyAreNew) {
  // Otherwise frames of the new times may come before those of the old ones are shown.
  std::promise<void> shown;
  SteppedPipeline pipeline(kPlayer);
  pipeline.retime([&](int n, GstClockTime pts) {
    if (n == 8) shown.get_future().wait();
    return n < 8 ? pts : pts - 4 * kFrame;
  });
  pipeline.set_state(GST_STATE_PLAYING);
  for (int n = 0; n < 8; ++n) EXPECT_EQ(pipeline.step().found, Found::kExact) << n;
  shown.set_value();
  // Frames 8 to 11 have the times of 4 to 7 again, and are shown at once.
  while (pipeline.await() < pipeline.now() + kFrame) pipeline.step();
  EXPECT_GT(play(pipeline, 4)[3].norm(), kMoves_px_s);
}

TEST(Semantics, AfterTheEndItCanBePlayedAgain) {
  SteppedPipeline pipeline(kPlayer);
  pipeline.set_state(GST_STATE_PAUSED);
  pipeline.seek(1.0, GST_SEEK_FLAG_FLUSH, 0, 6 * kFrame);
  pipeline.set_state(GST_STATE_PLAYING);
  play(pipeline, 6);
  pipeline.step();  // the end of the last frame
  pipeline.await_message(GST_MESSAGE_EOS);
  expect_rest(pipeline, 50 * GST_MSECOND);
  pipeline.seek(0);
  play_segment(pipeline);
}

TEST(Semantics, AfterAnErrorUpstreamNothingIsFelt) {
  // The queue is short: the error comes while frames are shown.
  SteppedPipeline pipeline(kBall + "! identity error-after=7 " + kMotion +
                           "! queue max-size-buffers=1 ! fakesink name=sink sync=true");
  pipeline.set_state(GST_STATE_PLAYING);
  EXPECT_GT(play(pipeline, 6)[5].norm(), kMoves_px_s);
  pipeline.await_message(GST_MESSAGE_ERROR);
  pipeline.await_end_of_stream();  // which the source sends after the error
  expect_rest(pipeline, kFrame + 50 * GST_MSECOND);
}

}  // namespace
}  // namespace spidar::test::semantics_test
