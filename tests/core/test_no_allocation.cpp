// The solvers run in the haptic thread, which must not touch the heap, on good input or bad; and
// the motion of a frame is found without it, whatever the scene does.
#include <algorithm>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "core/grip/pose_solver.h"
#include "core/grip/tension_solver.h"
#include "core/motion/motion_estimator.h"
#include "core/motion_analyzer.h"
#include "count_allocations.h"
#include "tests/support/moving_scene.h"
#include "tests/support/tension_cases.h"
#include "track_samples.h"

namespace spidar::test {
namespace {

TEST(NoAllocation, TheCounterCounts) {
  if (!kCountsAllocations) GTEST_SKIP() << "a sanitizer has the heap";
  // Volatile: a compiler that sees what is called may leave it out, or take the counter for
  // constant.
  void* (*volatile take)(size_t) = ::operator new;
  const size_t before = allocations;
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
    const size_t before = allocations;
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
    const size_t before = allocations;
    solver.solve(lengths);
    ASSERT_EQ(allocations, before) << "case " << n;
  }
}

constexpr int kWidth = 640;
constexpr int kHeight = 360;

Track as_track(const Displacement& point) {
  const Eigen::Vector2d middle((kWidth - 1) / 2.0, (kHeight - 1) / 2.0);
  const Eigen::Vector2f from = (middle + point.at_px).cast<float>();
  const Eigen::Vector2f to = (middle + point.at_px + point.moved_px).cast<float>();
  return {point.id, {from.x(), from.y()}, {to.x(), to.y()}};
}

/// A frame of a lively scene: the camera changes its kind every ten frames, objects enter and leave
/// again, there are strays, and now and then there are more tracks than are looked at, or none.
std::vector<Track> lively_frame(TrackSource& source, int n) {
  std::vector<Track> tracks;
  if (n % 37 == 36) return tracks;
  const MotionModel camera = sample_model(static_cast<ModelKind>(n / 10 % kModelKinds));
  const int count = n % 23 == 22 ? 900 : 150;
  for (const Displacement& point : source.moved(camera, count, 0.1)) {
    tracks.push_back(as_track(point));
  }
  for (int k = 0; k < n / 5 % 6; ++k) {
    MotionModel own;
    own.kind = ModelKind::kSimilarity;
    own.shift_px << 8 - 3 * k, k % 2 == 0 ? 9 : -9;
    own.linear << 0.03 * k, -0.02, 0.02, 0.03 * k;
    const Eigen::Vector2d middle(-250 + 100 * k, 20 * k - 50);
    for (uint32_t i = 0; i < 12; ++i) {
      const double dx = source.uniform(-30, 30);
      Displacement point =
          source.moved(own, middle + Eigen::Vector2d(dx, source.uniform(-30, 30)), 0.1);
      point.id = 1'000'000 + 100 * static_cast<uint32_t>(k) + i;
      tracks.push_back(as_track(point));
    }
  }
  for (int i = 0; i < 20; ++i) tracks.push_back(as_track(source.stray()));
  return tracks;
}

TEST(NoAllocation, Motion) {
  for (const MotionKind kind :
       {MotionKind::kMean, MotionKind::kObject, MotionKind::kObjects, MotionKind::kCamera}) {
    TrackSource source(3);
    MotionEstimator estimator;
    int most_objects = 0;
    for (int n = 0; n < 150; ++n) {
      const std::vector<Track> tracks = lively_frame(source, n);
      if (n % 60 == 59) estimator.reset();
      const size_t before = allocations;
      const SceneMotion scene = estimator.estimate(kind, tracks, kWidth, kHeight, 40'000'000);
      ASSERT_EQ(allocations, before) << "motion " << static_cast<int>(kind) << ", frame " << n;
      most_objects = std::max(most_objects, scene.objects);
    }
    const bool looks_for_objects = kind == MotionKind::kObject || kind == MotionKind::kObjects;
    EXPECT_EQ(most_objects > 2, looks_for_objects) << "the scene is lively";
  }
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
    const size_t before = allocations;
    analyzer.analyze(picture, (n + 1) * int64_t{33'333'333});
    if (n >= kFirstFrames) {
      ASSERT_EQ(allocations, before) << "frame " << n;
    }
  }
}

}  // namespace
}  // namespace spidar::test
