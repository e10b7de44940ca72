#include <cstring>
#include <limits>

#include <gtest/gtest.h>

#include "core/force/wrench_timeline.h"

namespace spidar {
namespace {

constexpr int64_t kFrame_ns = 40'000'000;

/// A wrench with six different, not round components.
Wrench wrench_of(double k) {
  return {{0.1 * k, -0.2 * k, 0.3 * k}, {0.01 * k, 0.02 / (k + 7), -0.03 * k}};
}

TimedWrench timed(int64_t time_ns, double k, int64_t hold_ns = kFrame_ns) {
  return {time_ns, hold_ns, wrench_of(k)};
}

bool same_bits(const Wrench& a, const Wrench& b) {
  const Eigen::Matrix<double, 6, 1> x = a.stacked();
  const Eigen::Matrix<double, 6, 1> y = b.stacked();
  return std::memcmp(x.data(), y.data(), sizeof(double) * 6) == 0;
}

WrenchTimeline two_frames() {
  WrenchTimeline timeline;
  EXPECT_TRUE(timeline.push(timed(0, 1)));
  EXPECT_TRUE(timeline.push(timed(kFrame_ns, 3)));
  return timeline;
}

TEST(WrenchTimeline, IsEmptyAtFirst) {
  const TimelineResult result = WrenchTimeline().at(0);
  EXPECT_EQ(result.found, Found::kNothing);
  EXPECT_TRUE(same_bits(result.wrench, Wrench()));
  EXPECT_EQ(result.frame_time_ns, INT64_MIN);
}

TEST(WrenchTimeline, ShowsNothingBeforeTheFirstFrame) {
  const TimelineResult result = two_frames().at(-1);
  EXPECT_EQ(result.found, Found::kNothing);
  EXPECT_TRUE(same_bits(result.wrench, Wrench()));
  EXPECT_EQ(result.frame_time_ns, INT64_MIN);
}

TEST(WrenchTimeline, IsExactAtTheTimeOfAFrame) {
  const WrenchTimeline timeline = two_frames();
  const TimelineResult first = timeline.at(0);
  EXPECT_EQ(first.found, Found::kExact);
  EXPECT_TRUE(same_bits(first.wrench, wrench_of(1)));
  const TimelineResult last = timeline.at(kFrame_ns);
  EXPECT_EQ(last.found, Found::kExact);
  EXPECT_TRUE(same_bits(last.wrench, wrench_of(3)));
  EXPECT_EQ(last.frame_time_ns, kFrame_ns);
}

TEST(WrenchTimeline, InterpolatesLinearlyBetweenFrames) {
  const WrenchTimeline timeline = two_frames();
  for (const int64_t time_ns : {int64_t{1}, kFrame_ns / 4, kFrame_ns / 2, kFrame_ns - 1}) {
    const double s = static_cast<double>(time_ns) / static_cast<double>(kFrame_ns);
    const TimelineResult result = timeline.at(time_ns);
    EXPECT_EQ(result.found, Found::kInterpolated);
    EXPECT_EQ(result.frame_time_ns, 0);
    const Eigen::Matrix<double, 6, 1> expected =
        (1 - s) * wrench_of(1).stacked() + s * wrench_of(3).stacked();
    // Values below 1, a few roundings of 2^-53.
    EXPECT_LT((result.wrench.stacked() - expected).cwiseAbs().maxCoeff(), 1e-15) << time_ns;
  }
}

TEST(WrenchTimeline, IsContinuousAtAFrame) {
  WrenchTimeline timeline = two_frames();
  timeline.push(timed(2 * kFrame_ns, -5));
  const Eigen::Matrix<double, 6, 1> at = timeline.at(kFrame_ns).wrench.stacked();
  for (const int64_t side_ns : {-1, 1}) {
    const Eigen::Matrix<double, 6, 1> near = timeline.at(kFrame_ns + side_ns).wrench.stacked();
    // One nanosecond of the steepest slope, 0.3 N · 8 in a frame, and rounding.
    EXPECT_LT((near - at).cwiseAbs().maxCoeff(), 2.4 / static_cast<double>(kFrame_ns) + 1e-15);
  }
}

TEST(WrenchTimeline, HoldsTheLastFrameThenExpires) {
  WrenchTimeline timeline = two_frames();
  const TimelineResult held = timeline.at(2 * kFrame_ns);
  EXPECT_EQ(held.found, Found::kHeld);
  EXPECT_TRUE(same_bits(held.wrench, wrench_of(3)));
  const TimelineResult expired = timeline.at(2 * kFrame_ns + 1);
  EXPECT_EQ(expired.found, Found::kExpired);
  EXPECT_TRUE(same_bits(expired.wrench, wrench_of(3)));
  EXPECT_EQ(expired.frame_time_ns, kFrame_ns);
}

TEST(WrenchTimeline, WithoutAHoldTimeExpiresAtOnce) {
  for (const int64_t hold_ns : {int64_t{0}, int64_t{-5}}) {
    WrenchTimeline timeline;
    timeline.push(timed(0, 1, hold_ns));
    EXPECT_EQ(timeline.at(0).found, Found::kExact);
    EXPECT_EQ(timeline.at(1).found, Found::kExpired);
  }
}

TEST(WrenchTimeline, ALaterFrameRevivesAnExpiredOne) {
  WrenchTimeline timeline = two_frames();
  EXPECT_EQ(timeline.at(3 * kFrame_ns).found, Found::kExpired);
  timeline.push(timed(4 * kFrame_ns, 1));
  EXPECT_EQ(timeline.at(3 * kFrame_ns).found, Found::kInterpolated);
}

TEST(WrenchTimeline, RefusesTimesThatDoNotRise) {
  WrenchTimeline timeline = two_frames();
  EXPECT_FALSE(timeline.push(timed(kFrame_ns, 9)));
  EXPECT_FALSE(timeline.push(timed(kFrame_ns - 1, 9)));
  EXPECT_EQ(timeline.size(), 2u);
  EXPECT_TRUE(same_bits(timeline.at(kFrame_ns).wrench, wrench_of(3)));
}

TEST(WrenchTimeline, ForgetsTheOldestWhenFull) {
  WrenchTimeline timeline;
  constexpr auto kCount = static_cast<int>(WrenchTimeline::kCapacity) + 10;
  for (int i = 0; i < kCount; ++i) ASSERT_TRUE(timeline.push(timed(i * kFrame_ns, i)));
  EXPECT_EQ(timeline.size(), WrenchTimeline::kCapacity);
  EXPECT_EQ(timeline.at(9 * kFrame_ns).found, Found::kNothing);
  for (int i = 10; i < kCount; ++i) {
    const TimelineResult result = timeline.at(i * kFrame_ns);
    EXPECT_EQ(result.found, Found::kExact) << i;
    EXPECT_TRUE(same_bits(result.wrench, wrench_of(i))) << i;
  }
}

TEST(WrenchTimeline, AnswersInAnyOrder) {
  const WrenchTimeline timeline = two_frames();
  EXPECT_EQ(timeline.at(kFrame_ns).found, Found::kExact);
  EXPECT_EQ(timeline.at(1).found, Found::kInterpolated);
  EXPECT_EQ(timeline.at(-1).found, Found::kNothing);
  EXPECT_EQ(timeline.at(kFrame_ns).found, Found::kExact);
}

TEST(WrenchTimeline, ClearForgetsEverything) {
  WrenchTimeline timeline = two_frames();
  timeline.clear();
  EXPECT_EQ(timeline.size(), 0u);
  EXPECT_EQ(timeline.at(kFrame_ns).found, Found::kNothing);
  EXPECT_TRUE(timeline.push(timed(-5, 2)));
  EXPECT_EQ(timeline.at(-5).found, Found::kExact);
}

TEST(WrenchTimeline, SpansTheWholeRangeOfTime) {
  WrenchTimeline timeline;
  timeline.push(timed(std::numeric_limits<int64_t>::min(), 0));
  timeline.push(timed(std::numeric_limits<int64_t>::max(), 2));
  const TimelineResult middle = timeline.at(0);
  EXPECT_EQ(middle.found, Found::kInterpolated);
  // Half way but for half a nanosecond in 2^64.
  EXPECT_NEAR(middle.wrench.force_N.x(), 0.1, 1e-12);
  timeline.clear();
  timeline.push(timed(std::numeric_limits<int64_t>::min(), 1, 1));
  EXPECT_EQ(timeline.at(std::numeric_limits<int64_t>::max()).found, Found::kExpired);
}

}  // namespace
}  // namespace spidar
