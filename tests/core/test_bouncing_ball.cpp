// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The paper's Fig. 6–10 on a ball of known physics: position, velocity, acceleration and both
// controllers' forces are measured in pictures and compared with the analytic curves.
//
// Over an interval [a, b] the displacement of a track is p(b) − p(a) whatever happens in between,
// so the velocity to compare with is the exact mean (p(b) − p(a)) / (b − a). During a flight it
// equals the velocity at the middle of the interval, because velocity is linear in time. With an
// impact in the interval, it lies between the velocities before and after, and is exact as well.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/analysis/motion_analyzer.h"
#include "core/tracking/tracker.h"
#include "tests/support/ball_scene.h"
#include "tests/support/picture.h"

namespace spidar::test::bouncing_ball_test {
namespace {

using test::BallScene;
using test::BallSettings;
using test::Picture;

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

std::vector<Frame> analyze(const BallScene& scene,
                           const AnalyzerSettings& settings = paper_settings()) {
  Picture picture(scene.settings().width, scene.settings().height, 5);
  MotionAnalyzer analyzer(settings);
  std::vector<Frame> frames;
  for (int n = 0; n < kFrames; ++n) {
    scene.render(time_s(n), picture.pixels.data(), picture.stride);
    frames.push_back(analyzer.analyze(picture.view(), n * kFrame_ns));
  }
  return frames;
}

BallSettings ball(bool textured_background) {
  BallSettings settings;
  settings.textured_background = textured_background;
  settings.horizontal_px_s = 40;
  settings.start_px = {200, 60};
  return settings;
}

/// Large enough for some points whose windows see only the ball, in front of a texture.
BallSettings large_ball() {
  BallSettings settings = ball(true);
  settings.radius_px = 60;
  settings.start_px.y() = 70;
  settings.seed = 2;
  return settings;
}

/// Texture everywhere, with still and moving points at once: points on the ball are recognised by
/// their place.
struct BallTracks {
  int on_ball = 0;     ///< windows wholly on the ball, in both frames
  int background = 0;  ///< windows wholly beside it, in both frames
  int at_edge = 0;     ///< windows that see both
  Eigen::Vector2d on_ball_px = Eigen::Vector2d::Zero();  ///< mean displacement
  Eigen::Vector2d background_px = Eigen::Vector2d::Zero();

  int all() const { return on_ball + background + at_edge; }
};

BallTracks sort_tracks(const std::vector<Track>& tracks, const BallScene& scene, int n) {
  // A window of 15 px reaches 7.5 √2 px in its corners, and interpolation a pixel further.
  const double reach_px = 7.5 * std::sqrt(2.0) + 1;
  const double radius_px = scene.settings().radius_px;
  const Eigen::Vector2d before = scene.position_px(time_s(n - 1));
  const Eigen::Vector2d now = scene.position_px(time_s(n));
  BallTracks sorted;
  for (const Track& track : tracks) {
    const Eigen::Vector2d from(track.from.x_px, track.from.y_px);
    const Eigen::Vector2d to(track.to.x_px, track.to.y_px);
    const double from_px = (from - before).norm() - radius_px;
    const double to_px = (to - now).norm() - radius_px;
    if (from_px < -reach_px && to_px < -reach_px) {
      ++sorted.on_ball;
      sorted.on_ball_px += to - from;
    } else if (from_px > reach_px && to_px > reach_px) {
      ++sorted.background;
      sorted.background_px += to - from;
    } else {
      ++sorted.at_edge;
    }
  }
  if (sorted.on_ball > 0) sorted.on_ball_px /= sorted.on_ball;
  if (sorted.background > 0) sorted.background_px /= sorted.background;
  return sorted;
}

TEST(BouncingBall, TheSceneObeysItsPhysics) {
  const BallScene scene(ball(false));
  const BallSettings& s = scene.settings();
  const double drop_px = s.floor_px - s.radius_px - s.start_px.y();
  const std::vector<double> impacts = scene.impacts_s(time_s(kFrames));
  ASSERT_GE(impacts.size(), 4u);
  // h = ½ g t²; each flight is shorter than the last by the restitution; each top lower by its
  // square.
  EXPECT_NEAR(impacts[0], std::sqrt(2 * drop_px / s.gravity_px_s2), 1e-12);
  EXPECT_NEAR((impacts[3] - impacts[2]) / (impacts[2] - impacts[1]), s.restitution, 1e-9);
  const double top_s = (impacts[0] + impacts[1]) / 2;
  EXPECT_NEAR(scene.velocity_px_s(top_s).y(), 0, 1e-9);
  EXPECT_NEAR(s.floor_px - s.radius_px - scene.position_px(top_s).y(),
              s.restitution * s.restitution * drop_px, 1e-9);
  // The velocity reverses at the impact, and elsewhere is the slope of the position.
  const double before = scene.velocity_px_s(impacts[1] - 1e-9).y();
  EXPECT_NEAR(scene.velocity_px_s(impacts[1]).y(), -s.restitution * before, 1e-5);
  const double h = 1e-6;
  const Eigen::Vector2d slope =
      (scene.position_px(top_s / 2 + h) - scene.position_px(top_s / 2 - h)) / (2 * h);
  EXPECT_LT((slope - scene.velocity_px_s(top_s / 2)).norm(), 1e-4);
}

TEST(BouncingBall, VelocityFollowsTheAnalyticCurve) {
  const BallScene scene(ball(false));
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

TEST(BouncingBall, VelocityFollowsTheAnalyticCurveInAReducedPicture) {
  // 1280 px are reduced by 3: so is the precision.
  BallSettings settings = ball(false);
  settings.width *= 2;
  settings.height *= 2;
  settings.radius_px *= 2;
  settings.start_px *= 2;
  settings.floor_px *= 2;
  settings.gravity_px_s2 *= 2;
  settings.horizontal_px_s *= 2;
  const BallScene scene(settings);
  const std::vector<Frame> frames = analyze(scene);
  for (int n = 1; n < kFrames; ++n) {
    const Eigen::Vector2d error = frames[n].motion.velocity_px_s - mean_velocity(scene, n);
    EXPECT_LT(error.norm(), 3 * kVelocity_px_s) << "frame " << n << ", error " << error.transpose();
  }
}

TEST(BouncingBall, PositionFollowsTheAnalyticCurve) {
  const BallScene scene(ball(false));
  const std::vector<Frame> frames = analyze(scene);
  Eigen::Vector2d position = scene.position_px(0);
  for (int n = 1; n < kFrames; ++n) {
    position += frames[n].motion.velocity_px_s * kFrame_s;
    // Each step may err by kMean_px, at worst always the same way.
    EXPECT_LT((position - scene.position_px(time_s(n))).norm(), n * kMean_px) << n;
  }
}

TEST(BouncingBall, AccelerationFollowsTheAnalyticCurve) {
  const BallScene scene(ball(false));
  const std::vector<Frame> frames = analyze(scene);
  // Two velocities, each right to kVelocity_px_s, one frame apart: 90 of 1500 px/s².
  const double tolerance_px_s2 = 2 * kVelocity_px_s / kFrame_s;
  int flying = 0;
  for (int n = 2; n < kFrames; ++n) {
    const Eigen::Vector2d measured =
        (frames[n].motion.velocity_px_s - frames[n - 1].motion.velocity_px_s) / kFrame_s;
    const Eigen::Vector2d exact =
        (mean_velocity(scene, n) - mean_velocity(scene, n - 1)) / kFrame_s;
    EXPECT_LT((measured - exact).norm(), tolerance_px_s2) << n;
    // Without an impact in the two intervals it is gravity, downwards.
    if (!impact_between(scene, time_s(n - 2), time_s(n))) {
      ++flying;
      EXPECT_NEAR(measured.x(), 0, tolerance_px_s2) << n;
      EXPECT_NEAR(measured.y(), scene.settings().gravity_px_s2, tolerance_px_s2) << n;
    }
  }
  EXPECT_GE(flying, kFrames / 2);
}

TEST(BouncingBall, NonlinearForceIsEquation15OfTheAnalyticVelocity) {
  const BallScene scene(ball(false));
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
  const BallScene scene(ball(false));
  AnalyzerSettings settings = paper_settings();
  settings.controller.kind = ControllerKind::kLinear;
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

TEST(BouncingBall, PointsOnTheBallFollowItInFrontOfATexture) {
  const BallScene scene(large_ball());
  Picture picture(scene.settings().width, scene.settings().height);
  OpenCvTracker tracker;
  int compared = 0;
  for (int n = 0; n < kFrames; ++n) {
    scene.render(time_s(n), picture.pixels.data(), picture.stride);
    const TrackedFrame& frame = tracker.track(picture.view());
    if (n == 0) continue;
    ASSERT_NE(frame.picture, PictureKind::kFirst) << n;
    const BallTracks sorted = sort_tracks(frame.tracks, scene, n);
    ASSERT_GT(sorted.background, 50) << n;
    EXPECT_LT(sorted.background_px.norm(), kMean_px) << n;
    if (sorted.on_ball == 0) continue;
    ++compared;
    const Eigen::Vector2d moved = mean_velocity(scene, n) * kFrame_s;
    // Few points: no averaging.
    EXPECT_LT((sorted.on_ball_px - moved).norm(), 2 * kMean_px) << n << ": " << sorted.on_ball;
  }
  EXPECT_GE(compared, kFrames * 3 / 4);
}

TEST(BouncingBall, TheMeanIsBiasedByTheShareOfBackgroundPoints) {
  // Eq. 10 divides by all points: with a share s of them on the ball the frame velocity is s v, and
  // nearly all of the speed is lost when the ball is small.
  const BallScene scene(large_ball());
  Picture picture(scene.settings().width, scene.settings().height);
  OpenCvTracker tracker;
  double share_sum = 0;
  double ratio_sum = 0;
  int moving = 0;
  for (int n = 0; n < kFrames; ++n) {
    scene.render(time_s(n), picture.pixels.data(), picture.stride);
    const TrackedFrame& frame = tracker.track(picture.view());
    if (n == 0) continue;
    const Eigen::Vector2d v = mean_velocity(scene, n);
    const ImageMotion motion = mean_motion(frame.tracks, kFrame_ns);
    const BallTracks sorted = sort_tracks(frame.tracks, scene, n);
    const double share = static_cast<double>(sorted.on_ball) / sorted.all();
    const double edge_share = static_cast<double>(sorted.at_edge) / sorted.all();
    // A point at the edge follows the ball, stays, or does something in between.
    const Eigen::Vector2d expected = (share + edge_share / 2) * v;
    const double tolerance_px_s = edge_share / 2 * v.norm() + kVelocity_px_s;
    EXPECT_LT((motion.velocity_px_s - expected).norm(), tolerance_px_s)
        << "frame " << n << ": " << sorted.on_ball << " on the ball, " << sorted.at_edge
        << " at its edge, " << sorted.background << " beside it";
    if (v.norm() < 100) continue;
    ++moving;
    share_sum += share + edge_share / 2;
    ratio_sum += motion.velocity_px_s.dot(v) / v.squaredNorm();
  }
  ASSERT_GT(moving, kFrames / 2);
  const BallSettings& s = scene.settings();
  const double area_share = M_PI * s.radius_px * s.radius_px / (s.width * s.height);
  RecordProperty("area_of_the_ball_percent", std::to_string(100 * area_share));
  RecordProperty("points_on_the_ball_percent", std::to_string(100 * share_sum / moving));
  RecordProperty("speed_that_is_left_percent", std::to_string(100 * ratio_sum / moving));
  std::printf("ball %.1f %% of the picture, %.1f %% of the points, %.1f %% of its speed left\n",
              100 * area_share, 100 * share_sum / moving, 100 * ratio_sum / moving);
  // 5 % of the picture: nine tenths of the speed are gone.
  EXPECT_LT(ratio_sum / moving, 0.1);
}

}  // namespace
}  // namespace spidar::test::bouncing_ball_test
