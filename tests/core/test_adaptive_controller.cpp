// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "core/force/adaptive_controller.h"

namespace spidar::test::adaptive_controller_test {
namespace {

using Adaptive = AdaptiveController;

constexpr double kMax_N = 3.0;
constexpr double kAlpha_s_px = 0.01;
constexpr double kFrame_s = 0.04;
/// A few operations on numbers below 10.
constexpr double kRounding = 1e-13;

/// Plays a film with the given speed in each frame, and returns the last force.
double play(Adaptive& controller, double speed_px_s, double duration_s,
            double interval_s = kFrame_s) {
  double force_N = 0;
  for (int n = 0; n < std::lround(duration_s / interval_s); ++n) {
    force_N = controller.force_N({speed_px_s, interval_s});
  }
  return force_N;
}

double force_N(double excess_px_s, double scale_px_s) {
  return 2 * kMax_N / M_PI * std::atan(excess_px_s / scale_px_s);
}

TEST(AdaptiveController, StartsLikeTheNonlinearOneBeyondTheDeadZone) {
  for (const double speed : {3.0, 50.0, 102.1, 1e4}) {
    Adaptive controller(kMax_N, kAlpha_s_px);
    EXPECT_NEAR(controller.force_N(speed), force_N(speed - Adaptive::kLeast_px_s, 100), kRounding);
  }
}

TEST(AdaptiveController, ASteadySpeedConvergesToHalfOfTheMaximum) {
  // The controller adapts to a slow film as it does to a fast one. The dead zone takes its share:
  // (V − V₀) / V.
  for (const double speed : {20.0, 60.0, 300.0, 800.0}) {
    Adaptive controller(kMax_N, kAlpha_s_px);
    const double force = play(controller, speed, 90);
    // From a scale 8 times too large, ln 8 = 2.1: 1.1 T until the bound ends, and what is left
    // then falls by exp(−(90 / 6 − 1.1)) = 1e-6.
    EXPECT_NEAR(controller.scale_px_s(), speed, 2e-6 * speed) << speed;
    EXPECT_NEAR(force, force_N(speed - Adaptive::kLeast_px_s, speed), 1e-5) << speed;
  }
}

TEST(AdaptiveController, AttackAndReleaseTakeTheirTime) {
  // A step of half a neper is within the bound: after T the rest is 1/e of it.
  const double step = std::exp(0.5);
  Adaptive controller(kMax_N, kAlpha_s_px);
  play(controller, 100 * step, Adaptive::kAttack_s);
  EXPECT_NEAR(std::log(controller.scale_px_s() / 100), 0.5 * (1 - std::exp(-1)), kRounding);
  controller.reset();
  play(controller, 100 / step, Adaptive::kRelease_s);
  EXPECT_NEAR(std::log(controller.scale_px_s() / 100), -0.5 * (1 - std::exp(-1)), kRounding);
  // A step of 2 nepers: one neper takes T, of the other 1/e is left after T more.
  controller.reset();
  play(controller, 100 * std::exp(2), 2 * Adaptive::kAttack_s);
  EXPECT_NEAR(std::log(controller.scale_px_s() / 100), 2 - std::exp(-1), kRounding);
}

TEST(AdaptiveController, OneOutlierDoesNotWeakenTheFilm) {
  for (const double outlier_px_s : {1e3, 1e6, 1e300}) {
    Adaptive controller(kMax_N, kAlpha_s_px);
    const double before_N = play(controller, 50, 60);
    const double scale_px_s = controller.scale_px_s();
    EXPECT_LE(controller.force_N({outlier_px_s, kFrame_s}), kMax_N);
    // exp(Δt / T), however large it is; and dF / d ln S is Fmax / π at most.
    EXPECT_LT(std::log(controller.scale_px_s() / scale_px_s),
              kFrame_s / Adaptive::kAttack_s + kRounding);
    const double after_N = controller.force_N({50, kFrame_s});
    EXPECT_NEAR(after_N, before_N, kMax_N / M_PI * kFrame_s / Adaptive::kAttack_s) << outlier_px_s;
    EXPECT_LT(after_N, before_N);
  }
  // What eq. 12 makes of the smallest of them.
  LinearController linear(kMax_N);
  linear.force_N(50);
  linear.force_N(1e3);
  EXPECT_NEAR(linear.force_N(50), 0.05 * kMax_N, kRounding);
}

TEST(AdaptiveController, ASlowFilmIsFeltAndAFastOneIsNotAllAtTheLimit) {
  const auto film = [](double speed_px_s, GainController& controller) {
    // Speeds that rise and fall by a factor of two about the middle, once a second.
    std::vector<double> forces_N;
    for (int n = 0; n < 60 * 25; ++n) {
      const double t_s = n * kFrame_s;
      const double speed = speed_px_s * std::exp2(std::sin(2 * M_PI * t_s));
      forces_N.push_back(controller.force_N({speed, kFrame_s}));
    }
    std::sort(forces_N.begin(), forces_N.end());
    return forces_N[forces_N.size() / 2];
  };
  for (const double speed : {15.0, 100.0, 900.0}) {
    Adaptive adaptive(kMax_N, kAlpha_s_px);
    // In the end the scale is between the middle and the largest speed: the median force is between
    // that of the ratio ½, less what the dead zone takes, and that of 1.
    const double dead = 1 - Adaptive::kLeast_px_s / speed;
    EXPECT_GT(film(speed, adaptive), force_N(0.5 * dead, 1)) << speed;
    EXPECT_LT(film(speed, adaptive), force_N(1, 1)) << speed;
  }
  NonlinearController nonlinear(kMax_N, kAlpha_s_px);
  EXPECT_LT(film(15, nonlinear), 0.1 * kMax_N);
  EXPECT_GT(film(900, nonlinear), 0.9 * kMax_N);
}

TEST(AdaptiveController, RestGivesExactlyNoForceAndIsNotLearnt) {
  Adaptive controller(kMax_N, kAlpha_s_px);
  play(controller, 50, 3);
  const double scale_px_s = controller.scale_px_s();
  EXPECT_EQ(play(controller, 0, 100), 0);
  EXPECT_EQ(play(controller, Adaptive::kLeast_px_s, 100), 0);
  EXPECT_EQ(controller.force_N({30, kFrame_s, 10.0}), 0);  // 3 standard errors
  EXPECT_EQ(controller.scale_px_s(), scale_px_s);
}

TEST(AdaptiveController, TheDeadZoneHasNoStep) {
  for (const double noise_px_s : {0.0, 0.4, 5.0}) {
    const double edge_px_s = noise_px_s > 0 ? 3 * noise_px_s : Adaptive::kLeast_px_s;
    Adaptive controller(kMax_N, kAlpha_s_px);
    double last_N = 0;
    const double step_px_s = 0.01;
    for (double v = edge_px_s - 1; v < edge_px_s + 30; v += step_px_s) {
      const double now_N = controller.force_N({v, 0, noise_px_s});
      // dF / dV is 2 Fmax / (π S) at most.
      ASSERT_LE(std::fabs(now_N - last_N), 2 * kMax_N / M_PI / 100 * step_px_s + kRounding) << v;
      ASSERT_EQ(now_N > 0, v > edge_px_s) << v;
      last_N = now_N;
    }
    EXPECT_GT(last_N, 0.5);
  }
}

TEST(AdaptiveController, TheForceOfAMotionDoesNotDependOnTheFrameRate) {
  // ln V wanders about by 1.5 nepers at 0.5 Hz: its slope is 4.7 nepers a second at most.
  const auto speed = [](double t_s) { return 120 * std::exp(1.5 * std::sin(M_PI * t_s)); };
  const double slope_1_s = 1.5 * M_PI;
  Adaptive slow(kMax_N, kAlpha_s_px);
  Adaptive fast(kMax_N, kAlpha_s_px);
  const auto advance = [&](Adaptive& controller, int rate_Hz, int second) {
    double force = 0;
    for (int n = 1; n <= rate_Hz; ++n) {
      force = controller.force_N({speed(second + double(n) / rate_Hz), 1.0 / rate_Hz});
    }
    return force;
  };
  for (int second = 0; second < 30; ++second) {
    const double slow_N = advance(slow, 24, second);
    const double fast_N = advance(fast, 60, second);
    // A frame's speed stands for the whole interval before it, so what the scale follows leads by
    // up to an interval: both leads are 0 to 1/24 s, and the inputs differ by slope / 24 at most.
    // Following does not increase a difference of inputs, and dF / d ln S is Fmax / π at most.
    const double scales = slope_1_s / 24;
    EXPECT_NEAR(std::log(slow.scale_px_s()), std::log(fast.scale_px_s()), scales) << second;
    EXPECT_NEAR(slow_N, fast_N, kMax_N / M_PI * scales) << second;
  }
  // If the speed is constant between the frames of both, only rounding differs.
  Adaptive coarse(kMax_N, kAlpha_s_px);
  Adaptive fine(kMax_N, kAlpha_s_px);
  for (const double v : {30.0, 700.0, 4.0, 90.0}) {
    EXPECT_NEAR(play(coarse, v, 2, 1.0 / 24), play(fine, v, 2, 1.0 / 60), kRounding) << v;
  }
}

TEST(AdaptiveController, TheScaleStaysWithinADecadeOfAlpha) {
  std::mt19937 random(7);
  std::lognormal_distribution<double> speed(4, 4);
  Adaptive controller(kMax_N, kAlpha_s_px);
  for (int n = 0; n < 2000; ++n) {
    const double v = speed(random);
    SCOPED_TRACE(testing::Message() << "seed 7, draw " << n << ", speed " << v);
    const double force = controller.force_N({v, 10.0});
    EXPECT_TRUE(force >= 0 && force <= kMax_N) << force;
    EXPECT_GE(controller.scale_px_s(), 100 / Adaptive::kRange * (1 - kRounding));
    EXPECT_LE(controller.scale_px_s(), 100 * Adaptive::kRange * (1 + kRounding));
  }
}

TEST(AdaptiveController, NewLimitsKeepTheScaleAndResetForgetsIt) {
  Adaptive controller(kMax_N, kAlpha_s_px);
  play(controller, 300, 60);
  const double scale_px_s = controller.scale_px_s();
  controller.configure({ControllerKind::kAdaptive, 1.0, kAlpha_s_px});
  EXPECT_EQ(controller.scale_px_s(), scale_px_s);
  EXPECT_NEAR(controller.force_N(300), force_N(300 - Adaptive::kLeast_px_s, scale_px_s) / kMax_N,
              kRounding);
  // Outside a decade of the new α: clamped to its edge.
  controller.configure({ControllerKind::kAdaptive, kMax_N, 1.0});
  EXPECT_NEAR(controller.scale_px_s(), 10, kRounding);
  controller.reset();
  EXPECT_NEAR(controller.scale_px_s(), 1, kRounding);
  controller.configure({ControllerKind::kAdaptive, kMax_N, 0});
  EXPECT_EQ(controller.force_N(1e6), 0);
  controller.reset();
  controller.configure({ControllerKind::kAdaptive, kMax_N, kAlpha_s_px});
  EXPECT_NEAR(controller.scale_px_s(), 100, 100 * kRounding);
}

}  // namespace
}  // namespace spidar::test::adaptive_controller_test
