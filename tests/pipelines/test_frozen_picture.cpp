// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// A picture that stays on the screen for long is not felt, and the force always belongs to the
// frame that is shown. On a test clock; TickWatch also checks every tick.
#include "tests/pipelines/shown_motion.h"
#include "tests/support/test.h"

namespace spidar::test::frozen_picture_test {
namespace {

/// Held for 100 ms, at rest 40 ms later, and ten more until the clock has been read again.
constexpr GstClockTime kRest = 150 * GST_MSECOND;

/// Frames, and as many ticks: readings enough of the clock for a line that is followed when a few
/// of them stray, and good poses enough for a force.
constexpr int kBefore = 50;

/// Frames that the loop knows ahead: WrenchTimeline takes those of the next 100 ms, and one more.
constexpr int kAhead = 4;

TEST(FrozenPicture, TheClockStandsStill) {
  SteppedPipeline pipeline(kPlayer);
  pipeline.set_state(GST_STATE_PLAYING);
  play(pipeline, kBefore);
  pipeline.await();
  pipeline.await_analysed(kBefore + kAhead);
  EXPECT_GT(pipeline.idle(10 * GST_MSECOND).commanded.force_N.norm(), 0.01);
  EXPECT_EQ(pipeline.stand_still(kRest).commanded.stacked().norm(), 0);
  EXPECT_EQ(pipeline.stand_still(6 * GST_SECOND).commanded.stacked().norm(), 0);
  // It goes on: felt again, in time.
  pipeline.idle(kFrame - 10 * GST_MSECOND - GST_MSECOND);
  play(pipeline, 3);
  pipeline.await();
  EXPECT_GT(pipeline.idle(10 * GST_MSECOND).commanded.force_N.norm(), 0.01);
}

}  // namespace
}  // namespace spidar::test::frozen_picture_test
