// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Axes of plots: round numbers, and ranges that one outlier does not stretch.
#include "plugin/overlay/plot_axis.h"
#include "tests/support/test.h"

namespace spidar::test::plot_axis_test {
namespace {

TEST(PlotAxis, TicksAreRoundNumbersWithinTheRange) {
  const PlotAxis axis = make_axis(-3, 3, 6);
  EXPECT_EQ(axis.ticks(), (std::vector<double>{-3, -2, -1, 0, 1, 2, 3}));
  EXPECT_EQ(axis.label(-2), "-2");
  EXPECT_EQ(axis.fraction(-3), 0);
  EXPECT_EQ(axis.fraction(0), 0.5);
  EXPECT_EQ(axis.fraction(3), 1);
  EXPECT_EQ(make_axis(-3, 3, 5).ticks(), (std::vector<double>{-2, 0, 2}));
  EXPECT_EQ(make_axis(12, 388, 4).ticks(), (std::vector<double>{100, 200, 300}));
}

TEST(PlotAxis, LabelsTellNeighboursApart) {
  const PlotAxis axis = make_axis(0, 0.1, 5);
  ASSERT_EQ(axis.ticks().size(), 6u);
  EXPECT_EQ(axis.label(axis.ticks()[3]), "0.06");
  EXPECT_EQ(axis.label(-0.0), "0.00");
  EXPECT_EQ(make_axis(0, 1, 4).label(0.5), "0.5");
}

TEST(PlotAxis, NeverHasMoreStepsThanAskedFor) {
  for (double width = 1e-6; width < 1e7; width *= 1.37) {
    for (const int most : {1, 2, 3, 5, 10}) {
      for (const double low : {0.0, -width / 2, 0.3 * width}) {
        const PlotAxis axis = make_axis(low, low + width, most);
        EXPECT_LE((axis.high - axis.low) / axis.step, most * (1 + 1e-9)) << width;
        const double mantissa = axis.step / std::pow(10, std::floor(std::log10(axis.step) + 1e-9));
        EXPECT_TRUE(std::abs(mantissa - 1) < 1e-6 || std::abs(mantissa - 2) < 1e-6 ||
                    std::abs(mantissa - 5) < 1e-6)
            << axis.step;
        // No step is much smaller than needed either: the next smaller one would be too many.
        EXPECT_GT((axis.high - axis.low) / axis.step, most / 2.5 * (1 - 1e-9)) << width;
      }
    }
  }
}

TEST(PlotAxis, ARangeThatIsNoneBecomesOne) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const auto& [low, high] : {std::pair{2.0, 2.0}, {2.0, 1.0}, {2.0, kNan}, {2.0, kInfinity}}) {
    const PlotAxis axis = make_axis(low, high, 5);
    EXPECT_EQ(axis.low, 2);
    EXPECT_EQ(axis.high, 3);
    EXPECT_FALSE(axis.ticks().empty());
  }
  EXPECT_EQ(make_axis(kNan, 1, 5).low, 0);
  EXPECT_EQ(make_axis(0, 1, 0).ticks().size(), 2u) << "at least one step";
}

TEST(RoundTop, IsNeverFarAboveWhatItHasToHold) {
  for (double least = 0.01; least < 100; least *= 1.003) {
    const double top = round_top(least);
    EXPECT_GE(top, least * (1 - 1e-9));
    // The steps are furthest apart from 1 to 2.
    EXPECT_LE(top, 2 * least * (1 + 1e-9));
    if (least > 2 && least < 10) {
      EXPECT_LE(top, 1.5 * least * (1 + 1e-9)) << "2 to 3";
    }
  }
  EXPECT_EQ(round_top(2.1), 3);
  EXPECT_EQ(round_top(3), 3);
}

TEST(ForceAxis, FitsWhatIsFelt) {
  EXPECT_NEAR(force_axis_end_N(0), 0.1, 1e-9);
  EXPECT_NEAR(force_axis_end_N(0.13), 0.15, 1e-9) << "0.143 N in steps of 0.05 N";
  EXPECT_NEAR(force_axis_end_N(2.5), 3, 1e-9) << "2.75 N in steps of 1 N";
  for (double largest_N = 0.1; largest_N < 20; largest_N *= 1.01) {
    const double end_N = force_axis_end_N(largest_N);
    EXPECT_GE(end_N, 1.1 * largest_N * (1 - 1e-6));
    // A step is at most 2.5 times what is asked for, a quarter of the range.
    EXPECT_LE(end_N, 1.1 * largest_N * (1 + 2.5 / 4));
  }
}

TEST(RobustLargest, OneOutlierDoesNotFlattenFiveSeconds) {
  std::vector<double> values(300);
  for (size_t i = 0; i < values.size(); ++i) values[i] = 80 + static_cast<double>(i % 21);
  EXPECT_EQ(robust_largest(values), 100) << "without an outlier it is the largest";
  values[70] = 1e6;
  EXPECT_EQ(robust_largest(values), 1.5 * 99) << "1.5 times what 95 % do not exceed";
}

TEST(RobustLargest, WhatLastsIsNoOutlier) {
  std::vector<double> values(300, 10);
  std::fill(values.end() - 20, values.end(), 500);  // a third of a second of motion
  EXPECT_EQ(robust_largest(values), 500);
}

TEST(RobustLargest, HasNoTroubleWithFewValues) {
  EXPECT_EQ(robust_largest({}), 0);
  EXPECT_EQ(robust_largest({7}), 7);
  EXPECT_EQ(robust_largest({0, 0}), 0);
  std::vector<double> impulse(300, 0);
  impulse[4] = 30;
  EXPECT_EQ(robust_largest(impulse), 30) << "beside zeros there is nothing to flatten";
}

}  // namespace
}  // namespace spidar::test::plot_axis_test
