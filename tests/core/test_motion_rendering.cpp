// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/force/motion_rendering.h"
#include "tests/support/test.h"

namespace spidar::test::motion_rendering_test {
namespace {

/// A few operations on numbers near 1.
constexpr double kRounding = 1e-14;

ImageMotion moving(double x_px_s, double y_px_s, double growth_1_s, double roll_rad_s) {
  ImageMotion motion;
  motion.velocity_px_s << x_px_s, y_px_s;
  motion.growth_1_s = growth_1_s;
  motion.roll_rad_s = roll_rad_s;
  return motion;
}

TEST(MotionRendering, TheControllerSeesOneSpeedAndTheRatiosAreKept) {
  GainController controller({ControlLaw::kLinear, 3.0, 0.01});
  const Wrench wrench = render_motion(controller, moving(30, 40, 0.5, 0.25), {}, 480);
  // u = (30, 40, 120, 60); the largest so far is this one: full force.
  const double norm = std::sqrt(30.0 * 30 + 40 * 40 + 120 * 120 + 60 * 60);
  EXPECT_NEAR(wrench.force_N.x(), 3 * 30 / norm, kRounding);
  EXPECT_NEAR(wrench.force_N.y(), -3 * 40 / norm, kRounding);
  EXPECT_NEAR(wrench.force_N.z(), 3 * 120 / norm, kRounding);
  EXPECT_NEAR(wrench.torque_Nm.z(), -3 * kTorqueArm_m * 60 / norm, kRounding);
  EXPECT_LE(wrench.force_N.norm(), 3);
}

TEST(MotionRendering, AGainOfZeroTurnsAnAxisOff) {
  GainController controller({ControlLaw::kNonlinear, 3.0, 0.01});
  const ImageMotion motion = moving(60, -80, 0.5, 0.25);
  // 100 px/s: half of the force.
  const Wrench plane = render_motion(controller, motion, {0, 0}, 480);
  EXPECT_LT((plane.force_N - Eigen::Vector3d(0.9, 1.2, 0)).norm(), kRounding);
  EXPECT_EQ(plane.torque_Nm, Eigen::Vector3d(0, 0, 0));
  EXPECT_EQ(render_motion(controller, motion, {0, 1}, 480).force_N.z(), 0);
  EXPECT_EQ(render_motion(controller, motion, {1, 0}, 480).torque_Nm, Eigen::Vector3d(0, 0, 0));
  const Wrench twice = render_motion(controller, moving(0, 0, 100.0 / 480, 0), {2, 1}, 480);
  EXPECT_NEAR(twice.force_N.z(), 1.5, kRounding);
}

}  // namespace
}  // namespace spidar::test::motion_rendering_test
