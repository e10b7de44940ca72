// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A moving ball in a SteppedPipeline, and a check that the force matches the shown motion.
#pragma once

#include "tests/pipelines/stepped_pipeline.h"
#include "tests/support/test.h"

namespace spidar::test {

constexpr GstClockTime kFrame = 40 * GST_MSECOND;
/// Of two measurements of the same motion: a tenth of a pixel each (see test_frames.cpp), twice
/// that on 480 lines, over 40 ms.
constexpr double kTolerance_px_s = 2 * 0.1 * 2 / 0.04;
constexpr double kMoves_px_s = 40;  // the ball does five times as much
const std::string kBall =
    "videotestsrc pattern=ball name=source ! video/x-raw,format=GRAY8,width=320,height=240,"
    "framerate=25/1 ";
const std::string kMotion =
    "! spidarmotion name=motion motion=mean filter-min-cutoff=0 "
    "controller=nonlinear max-force=3 alpha=0.0005 ";
const std::string kSink = "! queue ! fakesink name=sink sync=true";
const std::string kPlayer = kBall + kMotion + kSink;

/// The tick must have found the wrench of the frame that the element had at this running time, bit
/// for bit, at the time of its motion; and where the tick did not come before the frame was shown,
/// one on the way from there to the next frame's.
inline void expect_wrench_of(SteppedPipeline& pipeline, const TickRecord& tick,
                             GstClockTime running_time) {
  const auto frame = pipeline.wrenches().find(running_time);
  ASSERT_NE(frame, pipeline.wrenches().end()) << "at " << running_time;
  if (pipeline.early_ns() > 0) {
    EXPECT_EQ(tick.found, Found::kExact);
    EXPECT_EQ(tick.wanted.force_N, frame->second.force_N);
    EXPECT_EQ(tick.wanted.torque_Nm, frame->second.torque_Nm);
    return;
  }
  EXPECT_TRUE(tick.found != Found::kNothing && tick.found != Found::kExpired);
  // The loop knows the next one before its frame has left the element.
  const auto after = std::next(frame);
  if (after == pipeline.wrenches().end()) return;
  const Wrench& next = after->second;
  constexpr double kRounding = 1e-15;  // a few, of numbers around 1
  for (int i = 0; i < 6; ++i) {
    const double here = frame->second.stacked()[i], there = next.stacked()[i];
    EXPECT_GE(tick.wanted.stacked()[i], std::min(here, there) - kRounding) << i;
    EXPECT_LE(tick.wanted.stacked()[i], std::max(here, there) + kRounding) << i;
  }
}

/// The same of the frame that is shown, which comes in time.
inline void expect_wrench_of_frame(SteppedPipeline& pipeline, const TickRecord& tick) {
  EXPECT_EQ(pipeline.shown(), pipeline.running_time());
  const auto frame = pipeline.wrenches().find(pipeline.running_time());
  ASSERT_NE(frame, pipeline.wrenches().end()) << "at " << pipeline.running_time();
  EXPECT_EQ(tick.running_ns + pipeline.early_ns(), static_cast<int64_t>(frame->first));
  const auto on_screen = pipeline.early_ns() > 0 ? std::prev(frame) : frame;
  EXPECT_EQ(tick.frame_ns, static_cast<int64_t>(on_screen->first));
  expect_wrench_of(pipeline, tick, pipeline.running_time());
}

/// The velocity that gives this force, px/s in a frame of 480 lines: equation 15, solved for it.
inline Eigen::Vector3d velocity_px_s(const Eigen::Vector3d& force_N) {
  const double speed = std::tan(M_PI / 2 * force_N.norm() / 3) / 0.0005;
  return speed > 0 ? Eigen::Vector3d(speed * force_N.normalized()) : Eigen::Vector3d::Zero();
}

/// Shows `count` frames, and returns the velocity that is felt at each.
inline std::vector<Eigen::Vector3d> play(SteppedPipeline& pipeline, int count) {
  std::vector<Eigen::Vector3d> felt_px_s;
  for (int n = 0; n < count; ++n) {
    SCOPED_TRACE(n);
    const TickRecord tick = pipeline.step();
    expect_wrench_of_frame(pipeline, tick);
    felt_px_s.push_back(velocity_px_s(tick.wanted.force_N));
  }
  return felt_px_s;
}

/// Nothing at all is commanded `after` that time.
inline void expect_rest(SteppedPipeline& pipeline, GstClockTime after) {
  EXPECT_EQ(pipeline.idle(after).commanded.stacked().norm(), 0);
}

}  // namespace spidar::test
