// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/analysis/motion_analyzer.h"
#include "core/force/gain_controller.h"
#include "core/force/motion_filter.h"
#include "tests/support/test.h"

namespace spidar::test::motion_filter_test {
namespace {

constexpr double kFrame_s = 0.04;
constexpr int kHeight = 480;
/// A few operations on numbers up to 1000.
constexpr double kRounding = 1e-11;
const double kTwoPi = 2 * M_PI;

using Filter1 = OneEuroFilter<1>;
using Filter2 = OneEuroFilter<2>;
using Scalar = Filter1::Vector;

ImageMotion moving(double x_px_s, double y_px_s, double growth_1_s = 0, double roll_rad_s = 0) {
  ImageMotion motion;
  motion.velocity_px_s << x_px_s, y_px_s;
  motion.growth_1_s = growth_1_s;
  motion.roll_rad_s = roll_rad_s;
  return motion;
}

TEST(OneEuroFilter, FollowsThePaperStepByStepButForTheSizeOfTheRate) {
  // Algorithm 1 and 2 of Casiez et al., in their own terms.
  const auto alpha = [](double cutoff_Hz, double period_s) {
    const double tau_s = 1 / (kTwoPi * cutoff_Hz);
    return 1 / (1 + tau_s / period_s);
  };
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0, 20);
  std::uniform_real_distribution<double> interval(0.005, 0.2);
  Filter1 filter;
  double x_hat = noise(random), dx_hat = 0;
  filter.filter(Scalar(x_hat), 1, 1, 1);
  for (int n = 0; n < 200; ++n) {
    const double x = noise(random) + n;
    const double period_s = interval(random);
    const double dx = std::fabs(x - x_hat) / period_s;
    dx_hat = alpha(1, period_s) * dx + (1 - alpha(1, period_s)) * dx_hat;
    const double a = alpha(1.5 + 0.02 * dx_hat, period_s);
    x_hat = a * x + (1 - a) * x_hat;
    ASSERT_NEAR(filter.filter(Scalar(x), period_s, 1.5, 0.02)[0], x_hat, kRounding)
        << "seed 3, step " << n;
  }
}

TEST(OneEuroFilter, DoesNotDependOnTheDirectionOfTheAxes) {
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, 30);
  Filter2 straight, turned;
  Eigen::Matrix2d turn;
  turn << 0.6, -0.8, 0.8, 0.6;
  for (int n = 0; n < 100; ++n) {
    const double x = noise(random);
    const Eigen::Vector2d v(x, noise(random));
    const Eigen::Vector2d a = straight.filter(v, kFrame_s, 2, 0.01);
    const Eigen::Vector2d b = turned.filter(turn * v, kFrame_s, 2, 0.01);
    ASSERT_LT((turn * a - b).norm(), kRounding) << "seed 5, step " << n;
  }
}

TEST(OneEuroFilter, TheDefaultDelayOfASteadyChangeCannotBeFelt) {
  const FilterSettings defaults;
  for (const double slope_px_s2 : {3.0, 30.0, 300.0, 3000.0}) {
    Filter1 filter;
    double worst_px_s = 0;
    for (int n = 0; n < 150; ++n) {
      const double x = slope_px_s2 * n * kFrame_s;
      const double y =
          filter.filter(Scalar(x), kFrame_s, defaults.min_cutoff_Hz, defaults.beta_s_px)[0];
      if (n > 25) worst_px_s = std::max(worst_px_s, std::fabs(x - y));  // the rate is known
    }
    EXPECT_LT(worst_px_s, DeadZone::kUnknownError_px_s) << slope_px_s2;
  }
}

/// The size of the rate of a sway, |cos|, has the mean 2 / π and, as its first harmonic, a ripple
/// of 4 / (3 π) at twice the rate of the sway. Of that of 1 Hz or faster, the low-pass of 1 Hz
/// leaves 1 / √(1 + 2²) or less, so that it has at least 0.45 of the largest rate. A slower sway it
/// follows: what it lacks then, it lacks where the rate is small.
TEST(OneEuroFilter, ASwayIsFollowedAtAnySizeAndRate) {
  const FilterSettings defaults;
  constexpr double kMinFraction = 2 / M_PI - 4 / (3 * M_PI) * 0.447;
  const double most_px_s = 1 / (kTwoPi * defaults.beta_s_px * kMinFraction);
  for (const double frame_s : {1.0 / 24, 1.0 / 30, 1.0 / 60})
    for (const double size_px_s : {50.0, 200.0, 800.0})
      for (const double rate_Hz : {0.25, 0.5, 1.0, 2.0}) {
        Filter1 filter;
        for (int n = 0; n * frame_s < 8; ++n) {
          const double x = size_px_s * std::sin(kTwoPi * rate_Hz * n * frame_s);
          const double y =
              filter.filter(Scalar(x), frame_s, defaults.min_cutoff_Hz, defaults.beta_s_px)[0];
          if (n * frame_s < 1) continue;  // the rate is not known yet
          ASSERT_LT(std::fabs(x - y), most_px_s)
              << size_px_s << " px/s at " << rate_Hz << " Hz, " << n * frame_s << " s";
        }
      }
}

TEST(MotionFilter, WithoutACutoffItIsTheVerySameMotion) {
  MotionFilter filter;
  const FilterSettings off{0, 0.01};
  for (int n = 0; n < 5; ++n) {
    const ImageMotion motion = moving(1.1 * n, -n / 3.0, n / 7.0, n / 11.0);
    const ImageMotion same = filter.filter(motion, 360, kFrame_s, off);
    EXPECT_EQ(same.velocity_px_s, motion.velocity_px_s);
    EXPECT_EQ(same.growth_1_s, motion.growth_1_s);
    EXPECT_EQ(same.roll_rad_s, motion.roll_rad_s);
  }
}

TEST(MotionFilter, FeelsTheSameInEverySizeOfTheFrame) {
  MotionFilter small, large;
  for (int n = 0; n < 20; ++n) {
    const double v = 100 * std::sin(n);
    const ImageMotion a = small.filter(moving(v, n), 240, kFrame_s, {});
    const ImageMotion b = large.filter(moving(4 * v, 4 * n), 960, kFrame_s, {});
    EXPECT_LT((4 * a.velocity_px_s - b.velocity_px_s).norm(), kRounding) << n;
  }
}

TEST(MotionFilter, ComesToRestExactly) {
  MotionFilter filter;
  const FilterSettings settings;
  filter.filter(moving(300, 200, 1, 1), kHeight, kFrame_s, settings);
  ImageMotion left;
  // A step of 40 ms leaves 1 / (1 + 2π 1 Hz 40 ms) = 0.8 of it or less: from 361 px/s to 0.1 px/s
  // in ln 3610 / ln 1.25 = 37 of them.
  for (int n = 0; n < 37; ++n) left = filter.filter(moving(0, 0), kHeight, kFrame_s, settings);
  EXPECT_EQ(left.velocity_px_s, Eigen::Vector2d(0, 0));
  EXPECT_EQ(left.growth_1_s, 0);
  EXPECT_EQ(left.roll_rad_s, 0);
}

TEST(MotionFilter, ReportsTheNoiseAfterFiltering) {
  // A steady motion with noise that is independent from frame to frame, many times over.
  constexpr int kRuns = 4000;
  std::mt19937 random(21);
  std::normal_distribution<double> noise(0, 2);
  const FilterSettings fixed{2, 0};
  double squares = 0, stated = 0;
  for (int run = 0; run < kRuns; ++run) {
    MotionFilter filter;
    ImageMotion steady;
    for (int n = 0; n < 6; ++n) {
      const double x = 50 + noise(random);
      ImageMotion motion = moving(x, noise(random));
      motion.dead_zone_px_s = 2;
      steady = filter.filter(motion, 240, kFrame_s, fixed);
    }
    squares += (steady.velocity_px_s - Eigen::Vector2d(50, 0)).squaredNorm() / 2;
    stated = steady.dead_zone_px_s;
  }
  // A standard deviation from 8000 draws is known to 1 / √16000 = 0.8 %; four of that.
  EXPECT_NEAR(std::sqrt(squares / kRuns), stated, 0.032 * stated) << "seed 21";
  EXPECT_LT(stated, 0.6 * 2);
  // Not known stays not known, and what is reset has the noise of the first value.
  MotionFilter filter;
  EXPECT_EQ(filter.filter(moving(10, 0), kHeight, kFrame_s, {}).dead_zone_px_s, 0);
  EXPECT_EQ(filter.filter(moving(20, 0), kHeight, kFrame_s, {}).dead_zone_px_s, 0);
}

}  // namespace
}  // namespace spidar::test::motion_filter_test
