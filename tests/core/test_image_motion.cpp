// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/motion/image_motion.h"
#include "tests/support/test.h"

namespace spidar::test::image_motion_test {
namespace {

FollowedPoint moved(float dx, float dy, float x = 100, float y = 50) {
  return {0, {x, y}, {x + dx, y + dy}};
}

TEST(MeanMotion, RefusesAnIntervalThatIsNotPositive) {
  EXPECT_THROW(mean_motion({moved(1, 0)}, 0), std::invalid_argument);
  EXPECT_THROW(mean_motion({}, -1), std::invalid_argument);
}

constexpr int kWidth = 640;
constexpr double kInterval_s = 0.04;
constexpr double kFastest_px_s = kWidth / kInterval_s;

ImageMotion moving(double x_px_s, double y_px_s, double growth_1_s = 0, double roll_rad_s = 0) {
  return {{x_px_s, y_px_s}, growth_1_s, roll_rad_s, 10, 1.5};
}

TEST(CameraMotion, IsTheInverseOfWhatThePictureDoes) {
  Background background;
  background.model.kind = ModelKind::kSimilarity;
  background.model.shift_px << 4, -2;
  background.model.linear << 0.25, 0, 0, 0.25;
  const ImageMotion camera = camera_motion(background, 100, 0.04);
  EXPECT_EQ(camera.velocity_px_s, Eigen::Vector2d(-100, 50));
  // A picture that grows by a quarter is seen by a camera that comes nearer by a fifth.
  EXPECT_NEAR(camera.growth_1_s, -0.2 / 0.04, 1e-12);
}

TEST(MotionBounds, VisibleMotionIsUnchanged) {
  const ImageMotion motion = moving(-0.6 * kFastest_px_s, 0.79 * kFastest_px_s, -24, 78);
  const ImageMotion bounded = bound_motion(motion, kWidth, kInterval_s);
  EXPECT_EQ(bounded.velocity_px_s, motion.velocity_px_s);
  EXPECT_EQ(bounded.growth_1_s, -24);
  EXPECT_EQ(bounded.roll_rad_s, 78);
  EXPECT_EQ(bounded.tracked, 10);
  EXPECT_EQ(bounded.dead_zone_px_s, 1.5);
}

TEST(MotionBounds, NothingIsFasterThanAFramesWidthAFrame) {
  for (const double speed_px_s : {2 * kFastest_px_s, 2e10, 1e300}) {
    const ImageMotion bounded =
        bound_motion(moving(0.6 * speed_px_s, -0.8 * speed_px_s), kWidth, kInterval_s);
    // A norm, a quotient, a product.
    const double rounding = 8 * std::numeric_limits<double>::epsilon() * kFastest_px_s;
    EXPECT_NEAR(bounded.velocity_px_s.x(), 0.6 * kFastest_px_s, rounding);
    EXPECT_NEAR(bounded.velocity_px_s.y(), -0.8 * kFastest_px_s, rounding);
  }
}

TEST(MotionBounds, NothingGrowsOrTurnsFasterThanCanBeSeen) {
  const ImageMotion bounded = bound_motion(moving(0, 0, 1e9, -1e9), kWidth, kInterval_s);
  EXPECT_EQ(bounded.growth_1_s, 1 / kInterval_s);
  EXPECT_NEAR(bounded.roll_rad_s, -M_PI / kInterval_s, 1e-12);
}

TEST(MotionBounds, NanIsNoMotion) {
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    const ImageMotion bounded = bound_motion(moving(bad, 1, bad, -bad), kWidth, kInterval_s);
    EXPECT_EQ(bounded.velocity_px_s.norm(), 0);
    EXPECT_EQ(bounded.growth_1_s, 0);
    EXPECT_EQ(bounded.roll_rad_s, 0);
  }
}

TEST(DeadZone, IsThreeStandardErrorsOrAPartOfTheBound) {
  MovingObject object;
  object.error_px_s = 25;
  EXPECT_NEAR(relative_motion(object).dead_zone_px_s, 3, 1e-14);
  Background background;
  background.sigma_px = 0.1;
  // 100 votes: 0.01 px, in 0.04 s.
  EXPECT_NEAR(camera_motion(background, 100, 0.04).dead_zone_px_s, 3 * 0.01 / 0.04, 1e-14);
  EXPECT_EQ(camera_motion(background, 0, 0.04).dead_zone_px_s, 0) << "not known";
}

}  // namespace
}  // namespace spidar::test::image_motion_test
