// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/track/track_reader.h"
#include "tests/support/test.h"

namespace spidar::test::track_reader_test {
namespace {

constexpr int64_t kMs = 1'000'000;

/// Samples whose force x is 0, 1, 2, … % of the full scale, from `first` on.
TrackBlock block_of(int64_t begin_ns, size_t count, int64_t period_ns, int first = 0) {
  TrackBlock block;
  block.begin_ns = begin_ns;
  block.count = count;
  block.duration_ns = static_cast<int64_t>(count) * period_ns;
  for (size_t i = 0; i < count; ++i) {
    block.samples[i] = TrackSample{0.01F * static_cast<float>(first + static_cast<int>(i))};
  }
  return block;
}

struct Reader {
  TimelineResult at(int64_t time_ns) {
    while (!blocks.empty() && reader.read(blocks.front(), time_ns)) blocks.erase(blocks.begin());
    return reader.at(time_ns, blocks.empty() ? nullptr : &blocks.front());
  }
  /// Of the full scale, in percent.
  double percent(int64_t time_ns) { return 10 * at(time_ns).wrench.force_N.x(); }

  TrackReader reader;
  std::vector<TrackBlock> blocks;
};

constexpr double kFloat = 1e-5;  // percent; a float has 6e-8 of its value

TEST(TrackReader, HasNothingBeforeTheFirstSample) {
  Reader reader;
  EXPECT_EQ(reader.at(0).found, Found::kNothing);
  reader.blocks = {block_of(10 * kMs, 40, kMs)};
  EXPECT_EQ(reader.at(10 * kMs - 1).found, Found::kNothing);
  EXPECT_EQ(reader.at(10 * kMs).found, Found::kExact);
}

TEST(TrackReader, IsExactAtSamplesAndLinearBetweenThemAlsoAcrossBlocks) {
  Reader reader;
  reader.blocks = {block_of(0, 40, kMs), block_of(40 * kMs, 40, kMs, 40)};
  for (int64_t time_ns = 0; time_ns < 79 * kMs; time_ns += kMs / 4) {
    const TimelineResult result = reader.at(time_ns);
    EXPECT_EQ(result.found, time_ns % kMs == 0 ? Found::kExact : Found::kInterpolated);
    EXPECT_EQ(result.frame_time_ns, time_ns / kMs * kMs);
    EXPECT_NEAR(10 * result.wrench.force_N.x(), static_cast<double>(time_ns) / kMs, kFloat);
  }
}

TEST(TrackReader, HoldsTheLastSampleForFiveMillisecondsOnly) {
  Reader reader;
  reader.blocks = {block_of(0, 40, kMs)};
  EXPECT_EQ(reader.at(39 * kMs + TrackReader::kHold_ns).found, Found::kHeld);
  EXPECT_EQ(reader.at(39 * kMs + TrackReader::kHold_ns + 1).found, Found::kExpired);
}

TEST(TrackReader, DoesNotInterpolateOverAGap) {
  Reader reader;
  reader.blocks = {block_of(0, 40, kMs), block_of(100 * kMs, 40, kMs, 50)};
  EXPECT_EQ(reader.at(42 * kMs).found, Found::kHeld);
  EXPECT_EQ(reader.at(60 * kMs).found, Found::kExpired);
  EXPECT_EQ(reader.at(100 * kMs).found, Found::kExact);
  EXPECT_NEAR(reader.percent(100 * kMs), 50, kFloat);
}

TEST(TrackReader, InTheSlowestMotionNoSampleIsFeltForLongerThanAFrame) {
  Reader reader;
  reader.blocks = {block_of(0, 4, 500 * kMs)};
  EXPECT_EQ(reader.at(99 * kMs).found, Found::kHeld);
  EXPECT_EQ(reader.at(101 * kMs).found, Found::kExpired);
  EXPECT_EQ(reader.at(500 * kMs).found, Found::kExact);
}

TEST(TrackReader, SkipsSamplesOlderThanTheLastFeltOne) {
  Reader reader;
  reader.blocks = {block_of(20 * kMs, 20, kMs, 20)};
  EXPECT_NEAR(reader.percent(30 * kMs), 30, kFloat);
  reader.blocks.push_back(block_of(0, 40, kMs, 60));
  EXPECT_NEAR(reader.percent(39 * kMs), 39, kFloat) << "the newer of two samples of one time";
}

TEST(TrackReader, AClockThatGoesBackFarStartsAgain) {
  Reader reader;
  reader.blocks = {block_of(0, 40, kMs)};
  reader.at(30 * kMs);
  EXPECT_EQ(reader.at(29 * kMs).found, Found::kHeld);
  EXPECT_EQ(reader.at(10 * kMs).found, Found::kNothing);
}

TEST(TrackThinner, GivesMeansOfAsManySamplesAsComeInAMillisecond) {
  TrackThinner thinner;
  thinner.begin(8000);
  ASSERT_EQ(thinner.group(), 8u);
  for (int i = 0; i < 24; ++i) {
    TrackSample sample{static_cast<float>(i)};
    const bool complete = thinner.add(sample);
    EXPECT_EQ(complete, i % 8 == 7);
    EXPECT_EQ(sample[0], static_cast<float>(i) - (complete ? 3.5F : 0.0F));
  }
  for (const int rate_Hz : {200, 999, 1000}) {
    thinner.begin(rate_Hz);
    TrackSample sample{0.25F};
    EXPECT_TRUE(thinner.add(sample));
    EXPECT_EQ(sample[0], 0.25F);
  }
  thinner.begin(1001);
  EXPECT_EQ(thinner.group(), 2u);
}

TEST(TrackThinner, TheMeanOfTheLargestNumbersIsFinite) {
  constexpr float kMax = std::numeric_limits<float>::max();
  TrackThinner thinner;
  for (const int rate_Hz : {2000, 3000, 7000, 8000}) {
    thinner.begin(rate_Hz);
    TrackSample sample;
    do {
      sample = {kMax, -kMax};
    } while (!thinner.add(sample));
    EXPECT_EQ(sample[0], kMax) << rate_Hz;
    EXPECT_EQ(sample[1], -kMax) << rate_Hz;
  }
}

}  // namespace
}  // namespace spidar::test::track_reader_test
