// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <cmath>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

#include "core/analysis/force_renderer.h"
#include "core/force/motion_rendering.h"

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

TEST(MotionRendering, VelocityIsScaledToTheReferenceFrameGrowthAndRollNeedNone) {
  GainController controller({ControlLaw::kNonlinear, 3.0, 0.01});
  const Wrench small = render_motion(controller, moving(30, 0, 0.1, 0.2), {}, 240);
  const Wrench large = render_motion(controller, moving(120, 0, 0.1, 0.2), {}, 960);
  EXPECT_LT((small.stacked() - large.stacked()).norm(), kRounding);
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

TEST(MotionRendering, NoMotionIsNoForce) {
  GainController controller({ControlLaw::kLinear, 3.0, 0.01});
  EXPECT_EQ(render_motion(controller, ImageMotion(), {}, 480).stacked(),
            (Eigen::Matrix<double, 6, 1>::Zero()));
}

TEST(MotionRendering, RefusesWhatIsNotAGain) {
  for (const double bad :
       {-1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(validate(AxisGains{bad, 1}), std::invalid_argument);
    EXPECT_THROW(validate(AxisGains{1, bad}), std::invalid_argument);
  }
  EXPECT_NO_THROW(validate(AxisGains{0, 0}));
}

Wrench pushing(double x_N, double turning_Nm = 0) {
  Wrench wrench;
  wrench.force_N.x() = x_N;
  wrench.torque_Nm.z() = turning_Nm;
  return wrench;
}

constexpr double kFrame_s = 0.04;  // 0.4 of kFade_s

Wrench felt(WrenchFade& fade, const Wrench& wrench, uint32_t object, double interval_s) {
  fade.turn_to(object);
  return fade.fade(wrench, interval_s);
}

TEST(WrenchFade, AnObjectThatBeginsIsFeltAtOnce) {
  WrenchFade fade;
  felt(fade, {}, 0, kFrame_s);
  EXPECT_EQ(felt(fade, pushing(2), 1, kFrame_s).force_N.x(), 2);
  // However fast it changes.
  EXPECT_EQ(felt(fade, pushing(-2), 1, kFrame_s).force_N.x(), -2);
  EXPECT_EQ(felt(fade, {}, 1, kFrame_s).force_N.x(), 0);
  for (int n = 0; n < 3; ++n) felt(fade, {}, 0, kFrame_s);
  EXPECT_EQ(felt(fade, pushing(2), 2, kFrame_s).force_N.x(), 2);
  fade.reset();
  EXPECT_EQ(felt(fade, pushing(-1), 3, kFrame_s).force_N.x(), -1);
}

TEST(WrenchFade, GoesFromOneObjectToAnother) {
  WrenchFade fade;
  felt(fade, pushing(2, 0.02), 1, kFrame_s);
  const Wrench first = felt(fade, pushing(-1), 2, kFrame_s);
  EXPECT_NEAR(first.force_N.x(), 0.6 * 2 - 0.4 * 1, kRounding);
  EXPECT_NEAR(first.torque_Nm.z(), 0.6 * 0.02, kRounding);
  EXPECT_NEAR(felt(fade, pushing(-2), 2, kFrame_s).force_N.x(), 0.2 * 2 - 0.8 * 2, kRounding);
  EXPECT_EQ(felt(fade, pushing(-2), 2, kFrame_s).stacked(), pushing(-2).stacked());
  // Back before it is over: from what is felt.
  felt(fade, pushing(2), 1, kFrame_s);
  EXPECT_NEAR(felt(fade, pushing(-2), 2, kFrame_s).force_N.x(), 0.6 * -0.4 - 0.4 * 2, kRounding);
}

TEST(WrenchFade, AnObjectThatIsLostFadesInTheSameTimeAtEveryFrameRate) {
  for (const int frames : {1, 2, 5, 10}) {
    const double interval_s = WrenchFade::kFade_s / frames;
    WrenchFade fade;
    double before_N = felt(fade, pushing(2), 1, interval_s).force_N.x();
    for (int n = 0; n < frames; ++n) {
      const double now_N = felt(fade, {}, 0, interval_s).force_N.x();
      EXPECT_NEAR(before_N - now_N, 2.0 / frames, 2 * frames * kRounding);
      before_N = now_N;
    }
    EXPECT_EQ(felt(fade, {}, 0, interval_s).force_N.x(), 0);
  }
}

}  // namespace
}  // namespace spidar::test::motion_rendering_test
