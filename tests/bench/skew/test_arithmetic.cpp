// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Arithmetic of the benchmark skew.

#include <cmath>

#include <gtest/gtest.h>

#include "tests/bench/skew/histogram.h"
#include "tests/bench/skew/skew.h"

namespace {

TEST(Histogram, IsNanWithoutValues) {
  EXPECT_EQ(Histogram().count(), 0u);
  EXPECT_TRUE(std::isnan(Histogram().quantile(0.5)));
}

TEST(Histogram, QuantilesAreWithinHalfABin) {
  Histogram values;
  for (int i = 1; i <= 1000; ++i) values.add(0.01 * i);
  // A bin is 1 % wide, and values 0.01 apart lie above and below the exact quantile.
  EXPECT_NEAR(values.quantile(0.5), 5.0, 0.005 * 5.0 + 0.01);
  EXPECT_NEAR(values.quantile(0.95), 9.5, 0.005 * 9.5 + 0.01);
  EXPECT_EQ(values.min(), 0.01);
  EXPECT_EQ(values.max(), 10.0);
  EXPECT_EQ(values.quantile(1.0), 10.0);
}

TEST(Histogram, KeepsSignsApart) {
  Histogram values;
  for (const double value : {-2.0, -1.0, 0.0, 1.0, 2.0}) values.add(value);
  EXPECT_NEAR(values.quantile(0.2), -2.0, 0.02);
  EXPECT_NEAR(values.quantile(0.4), -1.0, 0.01);
  EXPECT_EQ(values.quantile(0.6), 0.0);
  EXPECT_NEAR(values.quantile(0.8), 1.0, 0.01);
}

TEST(Histogram, LeavesOutWhatIsNotFinite) {
  Histogram values;
  values.add(NAN);
  values.add(INFINITY);
  EXPECT_EQ(values.count(), 0u);
}

TEST(Skew, JoinsInEitherOrder) {
  Skew skew;
  skew.shown(100, 1'000'000);
  skew.felt(100, 3'000'000);
  skew.felt(200, 5'000'000);
  skew.shown(200, 6'000'000);
  EXPECT_EQ(skew.signed_ms().count(), 2u);
  EXPECT_EQ(skew.signed_ms().max(), 2.0);
  EXPECT_EQ(skew.signed_ms().min(), -1.0);
  EXPECT_EQ(skew.size_ms().min(), 1.0);
}

TEST(Skew, CountsTheFirstTickOfAFrame) {
  Skew skew;
  for (const int64_t tick_ns : {2'000'000, 3'000'000, 4'000'000}) skew.felt(100, tick_ns);
  skew.shown(100, 2'000'000);
  EXPECT_EQ(skew.signed_ms().count(), 1u);
  EXPECT_EQ(skew.signed_ms().max(), 0.0);
}

TEST(Skew, ForgetsFramesThatWereNeverShown) {
  Skew skew;
  for (int64_t frame = 0; frame < 10'000; ++frame) skew.felt(frame, frame);
  skew.shown(0, 0);
  EXPECT_EQ(skew.signed_ms().count(), 0u);
  skew.shown(9'999, 9'999);
  EXPECT_EQ(skew.signed_ms().count(), 1u);
}

}  // namespace
