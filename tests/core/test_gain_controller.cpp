// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/force/gain_controller.h"
#include "core/motion/image_motion.h"
#include "tests/support/test.h"

namespace spidar::test::gain_controller_test {
namespace {

constexpr double kMax_N = 3.0;
constexpr double kAlpha_s_px = 0.01;

TEST(LinearController, TheSmallestSpeedOfAllDoesNotOverflow) {
  GainController controller({ControlLaw::kLinear, 3.0, kAlpha_s_px});
  EXPECT_EQ(controller.force_N(std::numeric_limits<double>::denorm_min()), 3.0);
}

constexpr double kFrame_s = 0.04;
/// Each result is some tens of roundings of 2^-53 on numbers below 10.
constexpr double kAdaptiveRounding = 1e-13;
/// Plays a film with the given speed in each frame, and returns the last force.
double play(GainController& controller, double speed_px_s, double duration_s,
            double interval_s = kFrame_s) {
  double force_N = 0;
  for (int n = 0; n < std::lround(duration_s / interval_s); ++n) {
    force_N = controller.force_N(speed_px_s, interval_s);
  }
  return force_N;
}

double force_N(double excess_px_s, double scale_px_s) {
  return 2 * kMax_N / M_PI * std::atan(excess_px_s / scale_px_s);
}

TEST(AdaptiveController, StartsLikeTheNonlinearOneBeyondTheDeadZone) {
  for (const double speed : {3.0, 50.0, 102.1, 1e4}) {
    GainController controller({ControlLaw::kAdaptive, kMax_N, kAlpha_s_px});
    EXPECT_NEAR(controller.force_N(speed), force_N(speed - DeadZone::kUnknownError_px_s, 100),
                kAdaptiveRounding);
    controller.reset();
    EXPECT_NEAR(controller.force_N(speed, 0, 1.5), force_N(speed - 1.5, 100), kAdaptiveRounding);
  }
}

TEST(AdaptiveController, ASteadySpeedConvergesToHalfOfTheMaximum) {
  // The controller adapts to a slow film as it does to a fast one. The dead zone takes its
  // part: (V − V₀) / V.
  for (const double speed : {20.0, 60.0, 300.0, 800.0}) {
    GainController controller({ControlLaw::kAdaptive, kMax_N, kAlpha_s_px});
    const double force = play(controller, speed, 90);
    // From a scale 8 times too large, ln 8 = 2.1: 1.1 T until the bound ends, and what is left
    // then falls by exp(−(90 / 6 − 1.1)) = 1e-6.
    EXPECT_NEAR(controller.scale_px_s(), speed, 2e-6 * speed) << speed;
    EXPECT_NEAR(force, force_N(speed - DeadZone::kUnknownError_px_s, speed), 1e-5) << speed;
  }
}

TEST(AdaptiveController, AttackAndReleaseTakeTheirTime) {
  // A step of half a neper is within the bound: after T the rest is 1/e of it.
  const double step = std::exp(0.5);
  GainController controller({ControlLaw::kAdaptive, kMax_N, kAlpha_s_px});
  play(controller, 100 * step, GainController::kAttack_s);
  EXPECT_NEAR(std::log(controller.scale_px_s() / 100), 0.5 * (1 - std::exp(-1)), kAdaptiveRounding);
  controller.reset();
  play(controller, 100 / step, GainController::kRelease_s);
  EXPECT_NEAR(std::log(controller.scale_px_s() / 100), -0.5 * (1 - std::exp(-1)),
              kAdaptiveRounding);
  // A step of 2 nepers: one neper takes T, of the other 1/e is left after T more.
  controller.reset();
  play(controller, 100 * std::exp(2), 2 * GainController::kAttack_s);
  EXPECT_NEAR(std::log(controller.scale_px_s() / 100), 2 - std::exp(-1), kAdaptiveRounding);
}

TEST(AdaptiveController, OneOutlierDoesNotWeakenTheFilm) {
  for (const double outlier_px_s : {1e3, 1e6, 1e300}) {
    GainController controller({ControlLaw::kAdaptive, kMax_N, kAlpha_s_px});
    const double before_N = play(controller, 50, 60);
    const double scale_px_s = controller.scale_px_s();
    EXPECT_LE(controller.force_N(outlier_px_s, kFrame_s), kMax_N);
    // exp(Δt / T), however large it is; and dF / d ln S is Fmax / π at most.
    EXPECT_LT(std::log(controller.scale_px_s() / scale_px_s),
              kFrame_s / GainController::kAttack_s + kAdaptiveRounding);
    const double after_N = controller.force_N(50, kFrame_s);
    EXPECT_NEAR(after_N, before_N, kMax_N / M_PI * kFrame_s / GainController::kAttack_s)
        << outlier_px_s;
    EXPECT_LT(after_N, before_N);
  }
  // What eq. 12 makes of the smallest of them.
  GainController linear({ControlLaw::kLinear, kMax_N, kAlpha_s_px});
  linear.force_N(50);
  linear.force_N(1e3);
  EXPECT_NEAR(linear.force_N(50), 0.05 * kMax_N, kAdaptiveRounding);
}

TEST(AdaptiveController, RestGivesExactlyNoForceAndIsNotLearnt) {
  GainController controller({ControlLaw::kAdaptive, kMax_N, kAlpha_s_px});
  play(controller, 50, 3);
  const double scale_px_s = controller.scale_px_s();
  EXPECT_EQ(play(controller, 0, 100), 0);
  EXPECT_EQ(play(controller, DeadZone::kUnknownError_px_s, 100), 0);
  EXPECT_EQ(controller.force_N(30, kFrame_s, 30.0), 0);  // its own dead zone
  EXPECT_EQ(controller.scale_px_s(), scale_px_s);
}

TEST(AdaptiveController, TheForceOfAMotionDoesNotDependOnTheFrameRate) {
  // Where the speed is constant between the frames of both, only rounding differs.
  GainController coarse({ControlLaw::kAdaptive, kMax_N, kAlpha_s_px});
  GainController fine({ControlLaw::kAdaptive, kMax_N, kAlpha_s_px});
  for (const double v : {30.0, 700.0, 4.0, 90.0}) {
    EXPECT_NEAR(play(coarse, v, 2, 1.0 / 24), play(fine, v, 2, 1.0 / 60), kAdaptiveRounding) << v;
  }
}

TEST(AdaptiveController, TheScaleStaysWithinADecadeOfAlpha) {
  std::mt19937 random(7);
  std::lognormal_distribution<double> speed(4, 4);
  GainController controller({ControlLaw::kAdaptive, kMax_N, kAlpha_s_px});
  for (int n = 0; n < 2000; ++n) {
    const double v = speed(random);
    SCOPED_TRACE(testing::Message() << "seed 7, draw " << n << ", speed " << v);
    const double force = controller.force_N(v, 10.0);
    EXPECT_TRUE(force >= 0 && force <= kMax_N) << force;
    EXPECT_GE(controller.scale_px_s(), 100 / GainController::kRange * (1 - kAdaptiveRounding));
    EXPECT_LE(controller.scale_px_s(), 100 * GainController::kRange * (1 + kAdaptiveRounding));
  }
}

TEST(AdaptiveController, NewLimitsKeepTheScaleAndResetForgetsIt) {
  GainController controller({ControlLaw::kAdaptive, kMax_N, kAlpha_s_px});
  play(controller, 300, 60);
  const double scale_px_s = controller.scale_px_s();
  controller.configure({ControlLaw::kAdaptive, 1.0, kAlpha_s_px});
  EXPECT_EQ(controller.scale_px_s(), scale_px_s);
  EXPECT_NEAR(controller.force_N(300),
              force_N(300 - DeadZone::kUnknownError_px_s, scale_px_s) / kMax_N, kAdaptiveRounding);
  // Outside a decade of the new α: clamped to its edge.
  controller.configure({ControlLaw::kAdaptive, kMax_N, 1.0});
  EXPECT_NEAR(controller.scale_px_s(), 10, kAdaptiveRounding);
  controller.reset();
  EXPECT_NEAR(controller.scale_px_s(), 1, kAdaptiveRounding);
  controller.configure({ControlLaw::kAdaptive, kMax_N, 0});
  EXPECT_EQ(controller.force_N(1e6), 0);
  controller.reset();
  controller.configure({ControlLaw::kAdaptive, kMax_N, kAlpha_s_px});
  EXPECT_NEAR(controller.scale_px_s(), 100, 100 * kAdaptiveRounding);
}

}  // namespace
}  // namespace spidar::test::gain_controller_test
