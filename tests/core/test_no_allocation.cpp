// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The solvers run in the haptic thread, which must not allocate, whether the input is good or bad.
// The motion of a frame is found without allocating as well, whatever the scene.
#include <algorithm>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "core/analysis/motion_analyzer.h"
#include "core/grip/pose_solver.h"
#include "core/grip/tension_solver.h"
#include "core/motion/motion_estimator.h"
#include "tests/support/allocation_count.h"
#include "tests/support/moving_scene.h"
#include "tests/support/tension_cases.h"
#include "track_samples.h"

namespace spidar::test::no_allocation_test {
namespace {

TEST(NoAllocation, TheCounterCounts) {
  if (!kCountsAllocations) GTEST_SKIP() << "a sanitizer has the heap";
  // Volatile, because a compiler that knows the callee may leave out the call, or take the counter
  // for constant.
  void* (*volatile take)(size_t) = ::operator new;
  const long before = allocations;
  void* something = take(800);
  EXPECT_GT(allocations, before);
  ::operator delete(something);
}

TEST(NoAllocation, TensionSolver) {
  Random random(1);
  TensionSolver solver;
  for (int n = 0; n < 12 * 200; ++n) {
    TensionProblem p = random_problem(random, static_cast<TensionCase>(n % kTensionCases));
    if (n % 100 == 0) p.W(0, 0) = std::numeric_limits<double>::quiet_NaN();
    const long before = allocations;
    solver.solve(p);
    ASSERT_EQ(allocations, before) << "case " << n;
  }
}

TEST(NoAllocation, PoseSolver) {
  const StringGeometry geometry = g6x3_geometry();
  Random random(2);
  PoseSolver solver(geometry);
  for (int n = 0; n < 500; ++n) {
    StringVector lengths = string_lengths_m(geometry, random_pose(random, 0.05, 1.4));
    if (n % 3 == 0) lengths[n % 8] += 0.01;     // one is wrong
    if (n % 7 == 0) lengths.setConstant(0.01);  // all are
    if (n % 50 == 0) lengths[0] = std::numeric_limits<double>::quiet_NaN();
    const long before = allocations;
    solver.solve(lengths);
    ASSERT_EQ(allocations, before) << "case " << n;
  }
}

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
    found.forget_motion();
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
