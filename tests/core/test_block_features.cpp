// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// What is measured of the blocks of a film, and what the network says of them.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/motion/motion_estimator.h"
#include "tests/support/moving_scene.h"

namespace spidar::test::block_features_test {
namespace {

constexpr int kWidth = 432;
constexpr int kHeight = 240;
constexpr double kRadius_px = 60;
constexpr int kFrames = 12;

/// A disc that moves before a background that the camera pans over, and how many of the blocks that
/// lie wholly inside or outside of it are judged to move.
struct Judged {
  int inside = 0;
  int inside_moving = 0;
  int outside = 0;
  int outside_moving = 0;
};

Judged judge(double camera_px, double disc_px) {
  MovingScene scene(kWidth, kHeight);
  scene.add_disc(kRadius_px);
  MotionEstimator estimator;
  estimator.moving_blocks().use_network(NetworkThresholds{});
  ReducedFrame reduced;
  MeasuredFrame found;
  Judged judged;
  for (int n = 0; n < kFrames; ++n) {
    const double x_px = disc_px * (n - kFrames / 2);
    const ImageView picture = scene.draw({{camera_px * n, 0}}, {{{x_px, 0}}});
    reduced.read(picture);
    found.forget_motion();
    found.interval_ns = 40'000'000;
    if (!estimator.estimate(picture, reduced, found)) continue;
    for (const float value : estimator.moving_blocks().features().values()) {
      EXPECT_TRUE(std::isfinite(value) && std::abs(value) <= kMostFeature) << "frame " << n;
    }
    if (n + 1 < kFrames) continue;
    const BlockGrid& grid = estimator.grid();
    for (int row = 0; row < grid.rows; ++row) {
      for (int column = 0; column < grid.columns; ++column) {
        const auto i = static_cast<size_t>(row * grid.columns + column);
        const double half_px = kBlock_px / 2.0;
        const double away_px = std::hypot(grid.x_px(column) + half_px - kWidth / 2.0 - x_px,
                                          grid.y_px(row) + half_px - kHeight / 2.0);
        const double reach_px = half_px * std::sqrt(2.0);
        if (away_px + reach_px < kRadius_px) {
          ++judged.inside;
          judged.inside_moving += estimator.moves(i);
        } else if (away_px - reach_px > kRadius_px) {
          ++judged.outside;
          judged.outside_moving += estimator.moves(i);
        }
      }
    }
  }
  return judged;
}

TEST(BlockFeatures, TheNetworkFindsADiscAndNothingElse) {
  for (const double camera_px : {0.0, 2.0}) {
    const Judged judged = judge(camera_px, -5);
    EXPECT_GT(2 * judged.inside_moving, judged.inside) << camera_px;
    EXPECT_LT(20 * judged.outside_moving, judged.outside) << camera_px;
  }
}

TEST(BlockFeatures, TheNetworkFindsNothingWhereAllMovesAlike) {
  const Judged judged = judge(3, 3);
  EXPECT_LT(20 * (judged.inside_moving + judged.outside_moving), judged.inside + judged.outside);
}

}  // namespace
}  // namespace spidar::test::block_features_test
