// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// A ball out of focus bounces in front of a wall. Its blocks have hardly any texture, but their
// pixels fit its own motion better than rest.
#include "core/analysis/motion_analyzer.h"
#include "tests/support/picture.h"
#include "tests/support/test.h"

namespace spidar::test::soft_balls_test {
namespace {

using Eigen::Vector2d;

constexpr int kWidth = 640;
constexpr int kHeight = 480;
constexpr int kFrames = 90;
constexpr int64_t kFrame_ns = 33'333'333;
constexpr double kFrame_s = 1 / 30.0;
/// Slower than this, whole pixels of the picture in which motion is measured hardly tell it.
constexpr double kMoves_px = 2;

/// Centre of the ball in each frame.
std::vector<Vector2d> path(double radius_px) {
  constexpr double kFalls_px = 2.2;  // more in each frame
  const double lowest_px = kHeight - 40 - radius_px;
  std::vector<Vector2d> positions{{200, 100}};
  double down_px = 0;
  while (positions.size() < kFrames) {
    down_px += kFalls_px;
    Vector2d next_px = positions.back() + Vector2d(1.5, down_px);
    if (next_px.y() > lowest_px) {
      next_px.y() = lowest_px;
      down_px *= -0.97;
    }
    positions.push_back(next_px);
  }
  return positions;
}

/// Fraction of the moving frames in which the ball's motion is right, as in the benchmark of real
/// films: within 30 degrees and a factor of 2.
double right_fraction(double radius_px, double edge_px, double noise_grey = 2) {
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, 1);
  std::vector<double> wall(kWidth * kHeight);
  for (double& grey : wall) grey = 75 + noise_grey * noise(random);
  // Every frame begins at another position of it.
  std::vector<double> grain(2 * kWidth * kHeight);
  for (double& grey : grain) grey = noise_grey / 2 * noise(random);
  const std::vector<Vector2d> positions = path(radius_px);
  Picture picture(kWidth, kHeight);
  MotionAnalyzer analyzer;
  int moving = 0;
  int right = 0;
  for (size_t n = 0; n < positions.size(); ++n) {
    const Vector2d step_px = n == 0 ? Vector2d(0, 0) : Vector2d(positions[n] - positions[n - 1]);
    const size_t first = random() % wall.size();
    const double reach_px = radius_px + edge_px + step_px.norm();
    picture.fill([&](double x, double y) {
      const Vector2d from_px = Vector2d(x, y) - positions[n];
      const auto at = static_cast<size_t>(y) * kWidth + static_cast<size_t>(x);
      const double behind = wall[at] + grain[first + at];
      if (from_px.squaredNorm() > reach_px * reach_px) return behind;
      double covered = 0;
      // The shutter is open for half of the frame.
      for (const double t : {-0.2, 0.0, 0.2}) {
        const double away_px = (from_px - t * step_px).norm();
        const double inside = std::clamp((radius_px + edge_px / 2 - away_px) / edge_px, 0.0, 1.0);
        covered += inside * (1 - 0.25 * std::min(1.0, std::pow(away_px / radius_px, 2))) / 3;
      }
      return behind + 85 * covered;
    });
    const Frame frame = analyzer.analyze(picture.view(), static_cast<int64_t>(n) * kFrame_ns);
    if (step_px.norm() < kMoves_px) continue;
    const Vector2d found_px = frame.motion.velocity_px_s * kFrame_s;
    ++moving;
    right += found_px.norm() > 0.5 * step_px.norm() && found_px.norm() < 2 * step_px.norm() &&
             found_px.dot(step_px) > std::cos(M_PI / 6) * found_px.norm() * step_px.norm();
  }
  return static_cast<double>(right) / moving;
}

class SoftBall : public testing::TestWithParam<int> {};

TEST_P(SoftBall, IsFollowedHoweverFarOutOfFocus) {
  // It begins to move three times, of which each may take two frames.
  for (const int edge_px : {2, 8, 16, 24}) {
    EXPECT_GE(right_fraction(GetParam(), edge_px), 0.9) << "edge of " << edge_px << " px";
  }
}

INSTANTIATE_TEST_SUITE_P(Radii, SoftBall, testing::Values(20, 40, 60));

TEST(SharpBall, IsFollowedHoweverSmall) {
  // It begins to move three times, of which each may take two of at least 84 frames; it bounces
  // twice, of which each may take one.
  for (const double noise_grey : {0.0, 2.0}) {
    for (const int radius_px : {8, 10, 14, 16, 30, 45}) {
      EXPECT_GE(right_fraction(radius_px, 2, noise_grey), 1 - 8 / 84.0)
          << "radius of " << radius_px << " px, noise of " << noise_grey;
    }
  }
}

}  // namespace
}  // namespace spidar::test::soft_balls_test
