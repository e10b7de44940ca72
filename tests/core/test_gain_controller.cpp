// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <cmath>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

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
}

TEST(LinearController, AStillPictureHasNoForce) {
  LinearController controller(3.0);
  EXPECT_EQ(controller.force_N(0), 0);
}

TEST(LinearController, ResetForgetsTheLargestSpeed) {
  LinearController controller(3.0);
  controller.force_N(1000);
  controller.reset();
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

}  // namespace
}  // namespace spidar::test::gain_controller_test
