// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The paper's Fig. 6–10 on a ball of known physics: its velocity and both controllers' forces are
// measured in pictures and compared with the analytic curves.
//
// Over an interval [a, b] the displacement of a track is p(b) − p(a) whatever happens in between,
// so the velocity to compare with is the exact mean (p(b) − p(a)) / (b − a). During a flight it
// equals the velocity at the middle of the interval, because velocity is linear in time. With an
// impact in the interval, it lies between the velocities before and after, and is exact as well.
#include "core/analysis/motion_analyzer.h"
#include "core/field/block_search.h"
#include "core/motion/objects/object_tracker.h"
#include "tests/support/ball_scene.h"
#include "tests/support/test.h"

namespace spidar::test::bouncing_ball_test {
namespace {

using test::BallScene;
using test::BallSettings;

constexpr int kFrames = 120;  // 4 s: five impacts
constexpr int64_t kFrame_ns = 1'000'000'000 / 30;
constexpr double kFrame_s = static_cast<double>(kFrame_ns) * 1e-9;

/// Error of a mean displacement on the ball, px of the reduced picture (640 × 360 is not reduced).
/// A single point is right to 0.1 px (tracker's test); the mean over the ball's points averages
/// what differs between them, but not what they share: the same fraction of a pixel and the soft
/// edge, which is drawn to a linear approximation of its cover. Half of a single one is allowed.
constexpr double kMean_px = 0.05;
/// … of a velocity.
constexpr double kVelocity_px_s = kMean_px / kFrame_s;

double time_s(int n) {
  return static_cast<double>(n * kFrame_ns) * 1e-9;
}

Eigen::Vector2d mean_velocity(const BallScene& scene, int n) {
  return (scene.position_px(time_s(n)) - scene.position_px(time_s(n - 1))) / kFrame_s;
}

bool impact_between(const BallScene& scene, double from_s, double to_s) {
  const std::vector<double> impacts = scene.impacts_s(to_s);
  return std::any_of(impacts.begin(), impacts.end(), [&](double t) { return t > from_s; });
}

std::vector<Frame> analyze(BallScene& scene, const AnalyzerSettings& settings = paper_settings()) {
  MotionAnalyzer analyzer(settings);
  std::vector<Frame> frames;
  for (int n = 0; n < kFrames; ++n) {
    frames.push_back(analyzer.analyze(scene.draw(time_s(n)), n * kFrame_ns));
  }
  return frames;
}

BallSettings ball() {
  BallSettings settings;
  settings.textured_background = false;
  settings.horizontal_px_s = 40;
  settings.start_px = {200, 60};
  return settings;
}

TEST(BouncingBall, VelocityFollowsTheAnalyticCurve) {
  BallScene scene(ball());
  const std::vector<Frame> frames = analyze(scene);
  int impacts = 0;
  for (int n = 1; n < kFrames; ++n) {
    ASSERT_TRUE(frames[n].has_motion_before()) << n;
    ASSERT_GE(frames[n].motion.tracked, 10) << n;
    const Eigen::Vector2d error = frames[n].motion.velocity_px_s - mean_velocity(scene, n);
    const bool impact = impact_between(scene, time_s(n - 1), time_s(n));
    impacts += impact;
    EXPECT_LT(error.norm(), kVelocity_px_s)
        << "frame " << n << (impact ? ", with an impact" : "") << ", error " << error.transpose();
    if (!impact) {
      const Eigen::Vector2d middle = scene.velocity_px_s(time_s(n) - kFrame_s / 2);
      EXPECT_LT((frames[n].motion.velocity_px_s - middle).norm(), kVelocity_px_s) << n;
    }
  }
  EXPECT_EQ(impacts, static_cast<int>(scene.impacts_s(time_s(kFrames - 1)).size()));
}

TEST(BouncingBall, ThatIsSmallIsFeltAgainSoonAfterItTurned) {
  // No block fits in the picture with the impact, and in the next one it moves unlike before.
  constexpr int kLost = 2;
  for (const int rate_Hz : {25, 30}) {
    BallSettings settings = ball();
    settings.radius_px = 10;
    settings.gravity_px_s2 = 800;
    BallScene scene(settings);
    MotionAnalyzer analyzer;
    const double interval_s = 1.0 / rate_Hz;
    const int impact = static_cast<int>(std::ceil(scene.impacts_s(4).front() / interval_s));
    for (int n = 0; n <= impact + kLost; ++n) {
      const Frame& frame =
          analyzer.analyze(scene.draw(n * interval_s), std::llround(1e9 * n * interval_s));
      if (n != impact - kLost && n != impact + kLost) continue;
      const Eigen::Vector2d moved_px =
          scene.position_px(n * interval_s) - scene.position_px((n - 1) * interval_s);
      // What a block's motion may be off, px of a picture of 427 × 240.
      EXPECT_LT((frame.motion.velocity_px_s * interval_s - moved_px).norm(), 1.5 * kMaxOff_px)
          << "frame " << n << " of " << rate_Hz << " a second, impact before " << impact;
    }
  }
}

TEST(BouncingBall, IsTheSameOnlyIfItIsKnownWellAndNoLayer) {
  constexpr double kSpeed_px = 6;
  Track ball;
  ball.state = Track::State::kHidden;
  ball.since_s = kFrame_s;
  ball.is_proven = true;
  ball.blocks_seen = 4 * Track::kConfirmBlocks;
  ball.expected.velocity_px_s = {0, kSpeed_px / kFrame_s};
  Region after;
  after.relative_px = {0, -kSpeed_px};
  EXPECT_TRUE(ball.has_bounced_to(after, kFrame_s));

  --ball.blocks_seen;
  EXPECT_FALSE(ball.has_bounced_to(after, kFrame_s)) << "seen for too short";
  ++ball.blocks_seen;
  ball.is_proven = false;
  EXPECT_FALSE(ball.has_bounced_to(after, kFrame_s)) << "may be a layer";
  ball.is_proven = ball.is_layer = true;
  EXPECT_FALSE(ball.has_bounced_to(after, kFrame_s)) << "looks like a layer";
}

TEST(BouncingBall, NonlinearForceIsEquation15OfTheAnalyticVelocity) {
  BallScene scene(ball());
  const std::vector<Frame> frames = analyze(scene);
  const double to_reference = kReferenceHeight_px / scene.settings().height;
  // As a map of vectors, F(|v|) v / |v| is nowhere steeper than at 0: 2 Fmax α / π.
  const double tolerance_N = 2 * 3.0 * 0.0025 / M_PI * kVelocity_px_s * to_reference;
  for (int n = 1; n < kFrames; ++n) {
    const Eigen::Vector2d v = to_reference * mean_velocity(scene, n);
    const double force_N = 2 * 3.0 / M_PI * std::atan(0.0025 * v.norm());
    const Eigen::Vector3d expected_N =
        force_N * Eigen::Vector3d(v.x(), -v.y(), 0) / v.norm();  // device: y up
    EXPECT_LT((frames[n].wrench.force_N - expected_N).norm(), tolerance_N) << n;
  }
}

TEST(BouncingBall, LinearForceIsEquations11To13OfTheAnalyticVelocity) {
  BallScene scene(ball());
  AnalyzerSettings settings = paper_settings();
  settings.controller.law = ControlLaw::kLinear;
  const std::vector<Frame> frames = analyze(scene, settings);
  double largest_px_s = 0;
  for (int n = 1; n < kFrames; ++n) {
    const Eigen::Vector2d v = mean_velocity(scene, n);
    largest_px_s = std::max(largest_px_s, v.norm());
    const double gain_N_s_px = 3.0 / largest_px_s;
    const Eigen::Vector3d expected_N = gain_N_s_px * Eigen::Vector3d(v.x(), -v.y(), 0);
    // v and Vmax err by at most kVelocity_px_s each, v ≤ Vmax: the quotient by twice their ratio,
    // to first order; what is left out is smaller by Vmax / kVelocity_px_s ≥ 20.
    const double tolerance_N = 1.1 * 3.0 * 2 * kVelocity_px_s / largest_px_s;
    EXPECT_LT((frames[n].wrench.force_N - expected_N).norm(), tolerance_N) << n;
  }
}

}  // namespace
}  // namespace spidar::test::bouncing_ball_test
