// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The motion of a frame is found without allocating, whatever the scene. Ticks of the loop are in
// tests/spidar/test_random_safety.cpp.
#include "core/analysis/motion_analyzer.h"
#include "core/motion/motion_estimator.h"
#include "tests/support/allocation_count.h"
#include "tests/support/moving_scene.h"
#include "tests/support/test.h"

namespace spidar::test::no_allocation_test {
namespace {

constexpr int kWidth = 640;
constexpr int kHeight = 360;

/// A lively scene: the camera changes its motion every ten frames, and discs come and go.
TEST(NoAllocation, Motion) {
  // Regions and objects come and go: after a turn of the scene all memory has been used once.
  constexpr int kTurn = 60;
  MovingScene scene(kWidth, kHeight);
  for (const double radius_px : {50.0, 40.0, 30.0}) scene.add_disc(radius_px);
  MotionEstimator estimator;
  ReducedFrame reduced;
  MeasuredFrame found;
  size_t most_objects = 0;
  for (int n = 0; n < 3 * kTurn; ++n) {
    const int t = n % kTurn;
    const Placement camera{
        {1.5 * t, 0}, t > 20 ? 1 + 0.01 * (t - 20) : 1, t > 40 ? 0.01 * (t - 40) : 0};
    const double x_px = -300 + 10 * t;
    const ImageView picture = scene.draw(camera, {{{x_px, 100}}, {{-x_px, -100}}, {{x_px, -20}}});
    if (t == kTurn - 1) estimator.reset();
    const long before = allocations;
    reduced.read(picture);
    found.clear_motion();
    found.interval_ns = 40'000'000;
    const bool is_compared = estimator.estimate(picture, reduced, found);
    if (n >= kTurn) {
      ASSERT_EQ(allocations, before) << "frame " << n;
    }
    if (is_compared) most_objects = std::max(most_objects, found.objects.size());
  }
  EXPECT_GT(most_objects, 1u) << "the scene is lively";
}

TEST(NoAllocation, AFrameOfVideo) {
  // From the picture to the wrench, the default way, after as many frames as everything needs to
  // have been used once: cells have had their turns and points have been lost.
  constexpr int kFirstFrames = 30;
  MovingScene scene(kWidth, kHeight);
  scene.add_disc(50);
  MotionAnalyzer analyzer;
  for (int n = 0; n < 60; ++n) {
    const double x_px = -250 + 8 * n;
    const ImageView picture = scene.draw({{1.5 * n, 0}}, {{{x_px, 20.0}}});
    const long before = allocations;
    analyzer.analyze(picture, (n + 1) * int64_t{33'333'333});
    if (n >= kFirstFrames) {
      ASSERT_EQ(allocations, before) << "frame " << n;
    }
  }
}

}  // namespace
}  // namespace spidar::test::no_allocation_test
