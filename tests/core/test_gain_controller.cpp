// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

#include "core/force/adaptive_controller.h"
#include "core/force/gain_controller.h"

namespace spidar::test::gain_controller_test {
namespace {

// Each result is a handful of roundings of 2^-53 on numbers below 10.
constexpr double kRounding = 1e-14;

TEST(LinearController, FollowsEquations11To13) {
  LinearController controller(3.0);
  // Vmax(T) is 100 until 400 comes, and stays 400.
  EXPECT_NEAR(controller.force_N(100), 3.0, kRounding);
  EXPECT_NEAR(controller.force_N(25), 3.0 / 100 * 25, kRounding);
  EXPECT_NEAR(controller.force_N(400), 3.0, kRounding);
  EXPECT_NEAR(controller.force_N(100), 3.0 / 400 * 100, kRounding);
  EXPECT_NEAR(controller.gain_N_s_px(), 3.0 / 400, kRounding);
}

TEST(LinearController, GainNeverRisesAndForceNeverExceedsTheMaximum) {
  LinearController controller(2.5);
  std::mt19937 random(11);
  std::lognormal_distribution<double> speed(4, 3);
  double gain = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 1000; ++i) {
    const double speed_px_s = speed(random);
    const double force_N = controller.force_N(speed_px_s);
    SCOPED_TRACE(testing::Message() << "seed 11, draw " << i << ", speed " << speed_px_s);
    EXPECT_LE(force_N, 2.5);
    EXPECT_GE(force_N, 0);
    EXPECT_LE(controller.gain_N_s_px(), gain);
    gain = controller.gain_N_s_px();
  }
}

TEST(LinearController, AStillPictureHasNoForceAndNoGain) {
  LinearController controller(3.0);
  EXPECT_EQ(controller.force_N(0), 0);
  EXPECT_EQ(controller.gain_N_s_px(), 0);
}

TEST(LinearController, ResetForgetsTheLargestSpeed) {
  LinearController controller(3.0);
  controller.force_N(1000);
  controller.reset();
  EXPECT_EQ(controller.gain_N_s_px(), 0);
  EXPECT_NEAR(controller.force_N(10), 3.0, kRounding);
}

TEST(LinearController, ANewLimitKeepsTheLargestSpeed) {
  LinearController controller(3.0);
  controller.force_N(200);
  controller.configure({ControllerKind::kLinear, 1.0, 0.01});
  EXPECT_NEAR(controller.force_N(100), 0.5, kRounding);
}

TEST(LinearController, TheSmallestSpeedOfAllDoesNotOverflow) {
  LinearController controller(3.0);
  EXPECT_EQ(controller.force_N(std::numeric_limits<double>::denorm_min()), 3.0);
}

TEST(NonlinearController, FollowsEquation15) {
  NonlinearController controller(3.0, 0.01);
  EXPECT_EQ(controller.force_N(0), 0);
  // atan 1 = π/4: half of the maximum at V = 1 / α.
  EXPECT_NEAR(controller.force_N(100), 1.5, kRounding);
  // atan √3 = π/3, atan 1/√3 = π/6.
  EXPECT_NEAR(controller.force_N(100 * std::sqrt(3.0)), 2.0, kRounding);
  EXPECT_NEAR(controller.force_N(100 / std::sqrt(3.0)), 1.0, kRounding);
  for (double speed = 1; speed < 1e7; speed *= 3) {
    EXPECT_NEAR(controller.force_N(speed), 2 * 3.0 / M_PI * std::atan(0.01 * speed), kRounding);
  }
}

TEST(NonlinearController, StaysBelowTheMaximumHoweverFast) {
  NonlinearController controller(3.0, 0.01);
  EXPECT_LE(controller.force_N(1e300), 3.0);
  EXPECT_NEAR(controller.force_N(1e300), 3.0, kRounding);
}

TEST(NonlinearController, RemembersNothing) {
  NonlinearController controller(3.0, 0.01);
  const double before_N = controller.force_N(50);
  controller.force_N(1e6);
  EXPECT_EQ(controller.force_N(50), before_N);
  controller.reset();
  EXPECT_EQ(controller.force_N(50), before_N);
}

TEST(MakeController, MakesTheKindAskedFor) {
  EXPECT_TRUE(
      dynamic_cast<LinearController*>(make_controller({ControllerKind::kLinear, 3, 0.01}).get()));
  const auto nonlinear = make_controller({ControllerKind::kNonlinear, 2, 0.02});
  EXPECT_NEAR(nonlinear->force_N(50), 1.0, kRounding);
  EXPECT_TRUE(
      dynamic_cast<AdaptiveController*>(make_controller({ControllerKind::kAdaptive}).get()));
}

TEST(MakeController, RefusesWhatIsNotAForceOrAFactor) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double bad : {-1.0, nan, infinity}) {
    EXPECT_THROW(make_controller({ControllerKind::kLinear, bad, 0.01}), std::invalid_argument);
    EXPECT_THROW(make_controller({ControllerKind::kNonlinear, 3, bad}), std::invalid_argument);
    EXPECT_THROW(make_controller({ControllerKind::kAdaptive, 3, bad}), std::invalid_argument);
  }
}

TEST(RenderMotion, RightIsRightAndUpIsUp) {
  NonlinearController controller(3.0, 0.01);
  // Image: y down. Device: y up.
  const Wrench right = render_motion(controller, {100, 0});
  EXPECT_NEAR(right.force_N.x(), 1.5, kRounding);
  EXPECT_EQ(right.force_N.y(), 0);
  const Wrench up = render_motion(controller, {0, -100});
  EXPECT_EQ(up.force_N.x(), 0);
  EXPECT_NEAR(up.force_N.y(), 1.5, kRounding);
  for (const Wrench& wrench : {right, up}) {
    EXPECT_EQ(wrench.force_N.z(), 0);
    EXPECT_EQ(wrench.torque_Nm, Eigen::Vector3d::Zero());
  }
}

TEST(RenderMotion, TheGainActsOnTheSpeedAndKeepsTheDirection) {
  NonlinearController controller(3.0, 0.01);
  const Wrench wrench = render_motion(controller, {60, 80});
  EXPECT_NEAR(wrench.force_N.norm(), 1.5, kRounding);
  EXPECT_NEAR(wrench.force_N.x(), 0.6 * 1.5, kRounding);
  EXPECT_NEAR(wrench.force_N.y(), -0.8 * 1.5, kRounding);
}

TEST(RenderMotion, NoVelocityIsNoForce) {
  LinearController controller(3.0);
  EXPECT_EQ(render_motion(controller, {0, 0}).stacked(), (Eigen::Matrix<double, 6, 1>::Zero()));
}

}  // namespace
}  // namespace spidar::test::gain_controller_test
