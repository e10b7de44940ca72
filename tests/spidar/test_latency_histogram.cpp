// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/realtime/latency_histogram.h"
#include "tests/support/test.h"

namespace spidar::test::latency_histogram_test {
namespace {

TEST(LatencyHistogram, QuantilesAreUpperEndsOfBins) {
  LatencyHistogram histogram;
  // 0.5, 1.5 … 99.5 µs: one in each of the first hundred bins.
  for (int64_t i = 0; i < 100; ++i) histogram.add(1000 * i + 500);
  EXPECT_EQ(histogram.count(), 100u);
  EXPECT_EQ(histogram.quantile_ns(0), 1000);
  EXPECT_EQ(histogram.quantile_ns(0.5), 50'000);
  EXPECT_EQ(histogram.quantile_ns(0.99), 99'000);
  EXPECT_EQ(histogram.quantile_ns(1), 99'500);  // not above the largest
}

TEST(LatencyHistogram, KeepsTheLargestOfAll) {
  LatencyHistogram histogram;
  histogram.add(-5);
  histogram.add(1'999'999);
  histogram.add(2'000'000);
  histogram.add(7'654'321);
  EXPECT_EQ(histogram.count(), 4u);
  EXPECT_EQ(histogram.quantile_ns(0.25), 1000);
  EXPECT_EQ(histogram.quantile_ns(0.5), 2'000'000);
  EXPECT_EQ(histogram.quantile_ns(0.75), 7'654'321);
  EXPECT_EQ(histogram.max_ns(), 7'654'321);
}

}  // namespace
}  // namespace spidar::test::latency_histogram_test
