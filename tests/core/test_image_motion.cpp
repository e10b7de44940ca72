// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "core/motion/image_motion.h"

namespace spidar::test::image_motion_test {
namespace {

Track moved(float dx, float dy, float x = 100, float y = 50) {
  return {0, {x, y}, {x + dx, y + dy}};
}

TEST(MeanMotion, OneTrackIsDisplacementOverTime) {
  // 0.5 s and whole pixels: every step of eq. 9 is exact in binary but the 1e-9, which is not; two
  // roundings of 2^-53 each are far below 1e-12.
  const ImageMotion motion = mean_motion({moved(8, -4)}, 500'000'000);
  EXPECT_NEAR(motion.velocity_px_s.x(), 16, 1e-12);
  EXPECT_NEAR(motion.velocity_px_s.y(), -8, 1e-12);
  EXPECT_EQ(motion.tracked, 1);
}

TEST(MeanMotion, IsTheMeanOverAllTracks) {
  const std::vector<Track> tracks{moved(8, 0), moved(0, 2), moved(-2, 4), moved(2, -2)};
  const ImageMotion motion = mean_motion(tracks, 250'000'000);
  EXPECT_NEAR(motion.velocity_px_s.x(), 8.0 / 4 / 0.25, 1e-12);
  EXPECT_NEAR(motion.velocity_px_s.y(), 4.0 / 4 / 0.25, 1e-12);
  EXPECT_EQ(motion.tracked, 4);
}

TEST(MeanMotion, StaticPointsCountInTheMean) {
  // Eq. 10 divides by all N points: three that stand still leave a quarter of the speed.
  const std::vector<Track> tracks{moved(8, 0), moved(0, 0), moved(0, 0), moved(0, 0)};
  EXPECT_NEAR(mean_motion(tracks, 1'000'000'000).velocity_px_s.x(), 2, 1e-12);
}

TEST(MeanMotion, HalfTheIntervalIsTwiceTheVelocity) {
  const ImageMotion slow = mean_motion({moved(3, 1)}, 40'000'000);
  const ImageMotion fast = mean_motion({moved(3, 1)}, 20'000'000);
  EXPECT_NEAR(fast.velocity_px_s.x(), 2 * slow.velocity_px_s.x(), 1e-10);
  EXPECT_NEAR(fast.velocity_px_s.y(), 2 * slow.velocity_px_s.y(), 1e-10);
}

TEST(MeanMotion, OneNanosecondAndOneHourAreIntervals) {
  EXPECT_NEAR(mean_motion({moved(1, 0)}, 1).velocity_px_s.x(), 1e9, 1e-3);
  EXPECT_NEAR(mean_motion({moved(36, 0)}, 3'600'000'000'000).velocity_px_s.x(), 0.01, 1e-15);
}

TEST(MeanMotion, NoTracksAreNoMotion) {
  const ImageMotion motion = mean_motion({}, 40'000'000);
  EXPECT_EQ(motion.velocity_px_s, Eigen::Vector2d::Zero());
  EXPECT_EQ(motion.tracked, 0);
}

TEST(MeanMotion, RefusesAnIntervalThatIsNotPositive) {
  EXPECT_THROW(mean_motion({moved(1, 0)}, 0), std::invalid_argument);
  EXPECT_THROW(mean_motion({}, -1), std::invalid_argument);
}

}  // namespace
}  // namespace spidar::test::image_motion_test
