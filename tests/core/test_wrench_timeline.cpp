// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/core/timeline_frames.h"
#include "tests/support/test.h"

namespace spidar::test::wrench_timeline_test {
namespace {

WrenchTimeline two_frames() {
  WrenchTimeline timeline;
  EXPECT_TRUE(timeline.push(timed(0, 1)));
  EXPECT_TRUE(timeline.push(timed(kFrame_ns, 3)));
  return timeline;
}

TEST(WrenchTimeline, ShowsNothingBeforeTheFirstFrame) {
  for (const TimelineResult& result : {WrenchTimeline().at(0), two_frames().at(-1)}) {
    EXPECT_EQ(result.found, Found::kNothing);
    EXPECT_TRUE(same_bits(result.wrench, Wrench()));
    EXPECT_EQ(result.frame_time_ns, INT64_MIN);
  }
}

TEST(WrenchTimeline, IsLevelWhereTheNextFrameIsNotKnown) {
  WrenchTimeline timeline = two_frames();
  for (const int64_t time_ns : {int64_t{1}, kFrame_ns / 4, kFrame_ns / 2, kFrame_ns - 1}) {
    const double s = static_cast<double>(time_ns) / static_cast<double>(kFrame_ns);
    const TimelineResult result = timeline.at(time_ns);
    EXPECT_EQ(result.found, Found::kInterpolated);
    EXPECT_EQ(result.frame_time_ns, 0);
    const double fraction = s * s * (3 - 2 * s);
    const Eigen::Matrix<double, 6, 1> expected =
        (1 - fraction) * wrench_of(1).stacked() + fraction * wrench_of(3).stacked();
    // Values below 1, a few roundings of 2^-53.
    EXPECT_LT((result.wrench.stacked() - expected).cwiseAbs().maxCoeff(), 1e-15) << time_ns;
  }
}

TEST(WrenchTimeline, IsAStraightLineWhereTheFramesAre) {
  WrenchTimeline timeline;
  // Unequal intervals, and a slope of 0.01 N/ms.
  for (const int64_t ms : {0, 10, 50, 60, 100, 130}) {
    timeline.push({1'000'000 * ms, 0, {{0.01 * static_cast<double>(ms), 0, 0}, {0, 0, 0}}});
  }
  // The first and the last frame have no neighbour to take the slope from.
  for (int64_t ms = 10; ms <= 100; ++ms) {
    EXPECT_NEAR(timeline.at(1'000'000 * ms).wrench.force_N.x(), 0.01 * static_cast<double>(ms),
                1e-15);
  }
}

TEST(WrenchTimeline, ReachesAFrameInTimeIfItIsKnownAnApproachAhead) {
  WrenchTimeline timeline;
  timeline.push(timed(0, 1));
  const int64_t known_ns = kFrame_ns - WrenchTimeline::approach_after(kFrame_ns);
  timeline.at(known_ns);
  timeline.push(timed(kFrame_ns, 3));
  EXPECT_EQ(timeline.at(kFrame_ns).found, Found::kExact);
  EXPECT_TRUE(same_bits(timeline.at(kFrame_ns).wrench, wrench_of(3)));
}

TEST(WrenchTimeline, ReachesALaterKnownFrameAnApproachAfterwards) {
  for (const int64_t late_ns :
       {-WrenchTimeline::approach_after(kFrame_ns) + 1, int64_t{0}, kFrame_ns / 4}) {
    SCOPED_TRACE(late_ns);
    WrenchTimeline timeline;
    timeline.push(timed(0, 1, kHold_ns));
    const int64_t known_ns = kFrame_ns + late_ns;
    timeline.at(known_ns);
    timeline.push(timed(kFrame_ns, 3));
    const int64_t met_ns = known_ns + WrenchTimeline::approach_after(kFrame_ns);
    EXPECT_TRUE(same_bits(timeline.at(known_ns).wrench, wrench_of(1)));
    EXPECT_EQ(timeline.at(met_ns - 1).found, Found::kInterpolated);
    EXPECT_EQ(timeline.at(met_ns - 1).frame_time_ns, kFrame_ns);
    EXPECT_EQ(timeline.at(met_ns).found, Found::kHeld);
    EXPECT_TRUE(same_bits(timeline.at(met_ns).wrench, wrench_of(3)));
  }
}

TEST(WrenchTimeline, TakesLongerWhenPicturesChangeRarelyExceptToRest) {
  constexpr int64_t kInterval_ns = 125'000'000;  // drawn on threes
  for (const double next_N : {3.0, 0.0}) {
    SCOPED_TRACE(next_N);
    WrenchTimeline timeline;
    timeline.push(timed(0, 1, 2 * kInterval_ns));
    timeline.at(kInterval_ns);
    timeline.push(next_N > 0 ? timed(kInterval_ns, next_N)
                             : TimedWrench{kInterval_ns, 0, Wrench()});
    const int64_t met_ns =
        kInterval_ns + (next_N > 0 ? WrenchTimeline::kLatest_ns : WrenchTimeline::kApproach_ns);
    EXPECT_EQ(timeline.at(met_ns - 1).found, Found::kInterpolated);
    EXPECT_NE(timeline.at(met_ns).found, Found::kInterpolated);
    const Wrench met = next_N > 0 ? wrench_of(next_N) : Wrench();
    EXPECT_TRUE(same_bits(timeline.at(met_ns).wrench, met));
  }
}

TEST(WrenchTimeline, AFrameAfterEverythingHasExpiredAppliesAtOnce) {
  WrenchTimeline timeline = two_frames();
  const int64_t expired_ns = 2 * kFrame_ns + 1;
  EXPECT_EQ(timeline.at(expired_ns).found, Found::kExpired);
  timeline.push({2 * kFrame_ns, 0, Wrench()});  // the end of the stream, which became known late
  EXPECT_EQ(timeline.at(expired_ns).found, Found::kExpired);
  EXPECT_TRUE(same_bits(timeline.at(expired_ns).wrench, Wrench()));
}

TEST(WrenchTimeline, ForFramesCloseTogetherTheApproachIsAnInterval) {
  constexpr int64_t kInterval_ns = 4'000'000;  // 240 frames/s
  WrenchTimeline timeline;
  timeline.push(timed(0, 1));
  timeline.at(0);
  timeline.push(timed(kInterval_ns, 3));
  EXPECT_EQ(timeline.at(kInterval_ns).found, Found::kExact);
}

TEST(WrenchTimeline, NanDoesNotAffectOtherFrames) {
  WrenchTimeline timeline;
  for (int i = 0; i < 5; ++i) timeline.push(timed(i * kFrame_ns, i == 2 ? std::nan("") : i));
  for (int64_t time_ns = 0; time_ns <= 4 * kFrame_ns; time_ns += kFrame_ns / 4) {
    const bool beside = time_ns > kFrame_ns && time_ns < 3 * kFrame_ns;
    EXPECT_NE(timeline.at(time_ns).wrench.is_finite(), beside) << time_ns;
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

constexpr int64_t kRamp_ns = WrenchTimeline::kRamp_ns;
constexpr int64_t kGap_ns = 8'000'000'000;

TEST(WrenchTimeline, InAGapTheLastFrameExpiresAndTheNextOneFadesInFromZero) {
  for (const bool known_from_the_start : {true, false}) {
    SCOPED_TRACE(known_from_the_start);
    WrenchTimeline timeline;
    timeline.push(timed(0, 1, kHold_ns));
    if (!known_from_the_start) timeline.at(kGap_ns / 2);
    timeline.push(timed(kGap_ns, 3));
    if (known_from_the_start) {
      EXPECT_EQ(timeline.at(kHold_ns).found, Found::kHeld);
      EXPECT_TRUE(same_bits(timeline.at(kHold_ns).wrench, wrench_of(1)));
    }
    for (const int64_t time_ns : {kHold_ns + 1, kGap_ns / 2, kGap_ns - kRamp_ns - 1}) {
      EXPECT_EQ(timeline.at(time_ns).found, Found::kExpired) << time_ns;
    }
    for (const double s : {0.0, 0.1, 0.5, 0.9}) {
      const int64_t left_ns = std::llround((1 - s) * static_cast<double>(kRamp_ns));
      const TimelineResult rising = timeline.at(kGap_ns - left_ns);
      EXPECT_EQ(rising.found, Found::kInterpolated);
      EXPECT_EQ(rising.frame_time_ns, 0);
      // Level at both ends. Values below 1, a few roundings of 2^-53.
      const Eigen::Matrix<double, 6, 1> expected = s * s * (3 - 2 * s) * wrench_of(3).stacked();
      EXPECT_LT((rising.wrench.stacked() - expected).cwiseAbs().maxCoeff(), 1e-15) << s;
    }
    EXPECT_EQ(timeline.at(kGap_ns).found, Found::kExact);
  }
}

TEST(WrenchTimeline, AnIntervalWithoutTimeForRestIsNoGap) {
  constexpr int64_t kLongest_ns = WrenchTimeline::kLongestHold_ns + 2 * kRamp_ns;
  for (const int64_t interval_ns : {int64_t{125'000'000}, kLongest_ns, kLongest_ns + 1}) {
    SCOPED_TRACE(interval_ns);
    WrenchTimeline timeline;
    timeline.push(timed(0, 1));
    timeline.push(timed(interval_ns, 1));
    const TimelineResult middle = timeline.at(interval_ns / 2);
    EXPECT_EQ(middle.found, interval_ns <= kLongest_ns ? Found::kInterpolated : Found::kExpired);
  }
}

TEST(WrenchTimeline, ALongerHoldNeedsALongerGap) {
  WrenchTimeline timeline;
  timeline.push(timed(0, 1, kGap_ns));
  timeline.push(timed(kGap_ns, 3));
  EXPECT_EQ(timeline.at(kGap_ns / 2).found, Found::kInterpolated);
}

TEST(WrenchTimeline, TheCurveGoesOnWithoutACornerAfterAGap) {
  WrenchTimeline timeline;
  timeline.push(timed(0, 1));
  timeline.push(timed(kGap_ns, 3));
  timeline.push(timed(kGap_ns + kRamp_ns, 6));  // equally far again, in the same time
  constexpr int64_t kStep_ns = 1000;
  const auto before = timeline.at(kGap_ns - kStep_ns).wrench.force_N;
  const auto after = timeline.at(kGap_ns + kStep_ns).wrench.force_N;
  // A straight line at this point: its slope is that of the chords.
  const Eigen::Vector3d slope_N_s = (after - before) / (2e-9 * kStep_ns);
  const Eigen::Vector3d chord_N_s = wrench_of(3).force_N / (1e-9 * kRamp_ns);
  // The curve bends by up to 18 d/T² (see test_wrench_timeline_random.cpp) on either side, halved
  // by what is opposite.
  const double bent_N_s = 18 * 0.9 / (0.04 * 0.04) * 1e-9 * kStep_ns;
  EXPECT_LT((slope_N_s - chord_N_s).cwiseAbs().maxCoeff(), bent_N_s);
}

TEST(WrenchTimeline, CountsFutureFrames) {
  WrenchTimeline timeline = two_frames();
  EXPECT_EQ(timeline.size_after(-1), 2u);
  EXPECT_EQ(timeline.size_after(0), 1u);
  EXPECT_EQ(timeline.size_after(kFrame_ns), 0u);
}

/// Of a motion that rises by 0.01 N a millisecond, as it is halfway between two pictures.
TimedWrench measured(int64_t before_ms, int64_t ms) {
  const double middle_ms = 0.5 * static_cast<double>(before_ms + ms);
  const int64_t kMs = 1'000'000;
  return {ms * kMs, 0, {{0.01 * middle_ms, 0, 0}, {0, 0, 0}}, false, (ms - before_ms) * kMs / 2};
}

TEST(WrenchTimeline, AMotionBetweenTwoPicturesIsThatOfTheirMiddle) {
  WrenchTimeline timeline;
  int64_t before_ms = 0;
  for (const int64_t ms : {20, 40, 80, 90, 130, 170}) {
    timeline.push(measured(before_ms, ms));
    before_ms = ms;
  }
  for (int64_t ms = 30; ms <= 110; ++ms) {
    const TimelineResult result = timeline.at(1'000'000 * ms);
    EXPECT_NEAR(result.wrench.force_N.x(), 0.01 * static_cast<double>(ms), 1e-15);
    EXPECT_EQ(result.found == Found::kExact, ms == 30 || ms == 60 || ms == 85 || ms == 110) << ms;
    EXPECT_EQ(result.late_ns, 0);
    const int64_t shown_ms = ms < 40 ? 20 : ms < 80 ? 40 : ms < 90 ? 80 : 90;
    EXPECT_EQ(result.frame_time_ns, 1'000'000 * shown_ms);
  }
}

TEST(WrenchTimeline, WhereEachFrameIsKnownWhenItIsDueTheMotionBeforeItChangesNothing) {
  for (const int64_t interval_ns : {int64_t{16'666'667}, kFrame_ns, int64_t{83'333'333}}) {
    SCOPED_TRACE(interval_ns);
    const int64_t hold_ns = WrenchTimeline::hold_after(interval_ns);
    WrenchTimeline at_frame, in_the_middle;
    int64_t next_ns = 0;
    int n = 0;
    // Ten frames, and then none until all has expired.
    for (int64_t now_ns = 0; now_ns < 14 * interval_ns + 4 * kRamp_ns; now_ns += 1'000'000) {
      for (; n < 10 && next_ns <= now_ns; next_ns += interval_ns, ++n) {
        const Wrench wrench = wrench_of(1 + n % 3);
        at_frame.push({next_ns, hold_ns, wrench});
        in_the_middle.push({next_ns, hold_ns, wrench, false, n > 0 ? interval_ns / 2 : 0});
      }
      const TimelineResult expected = at_frame.at(now_ns), result = in_the_middle.at(now_ns);
      ASSERT_TRUE(same_bits(result.wrench, expected.wrench)) << now_ns;
      ASSERT_EQ(result.found == Found::kExpired, expected.found == Found::kExpired) << now_ns;
      ASSERT_EQ(result.frame_time_ns, expected.frame_time_ns) << now_ns;
    }
    const int64_t approach_ns =
        std::min(WrenchTimeline::approach_after(interval_ns), WrenchTimeline::kLatest_ns);
    // The present is that of the tick before, or of the frame itself.
    const int64_t late_ns = in_the_middle.at(next_ns).late_ns;
    EXPECT_LE(late_ns, interval_ns / 2 + approach_ns);
    EXPECT_GE(late_ns, interval_ns / 2 + approach_ns - 1'000'000);
  }
}

TEST(WrenchTimeline, TheMotionOfAFrameThatIsAheadIsHeldUntilItIsShown) {
  WrenchTimeline timeline;
  timeline.push({0, 0, Wrench()});  // expires at once
  TimedWrench next = timed(kFrame_ns, 2);
  next.before_ns = kFrame_ns / 2;
  timeline.push(next);
  const TimelineResult result = timeline.at(kFrame_ns * 3 / 4);
  EXPECT_EQ(result.found, Found::kHeld);
  EXPECT_TRUE(same_bits(result.wrench, wrench_of(2)));
  EXPECT_EQ(timeline.at(2 * kFrame_ns).found, Found::kHeld);
  EXPECT_EQ(timeline.at(2 * kFrame_ns + 1).found, Found::kExpired);
}

TEST(WrenchTimeline, AMotionBeforeTheFrameBeforeFollowsThatAtOnce) {
  WrenchTimeline timeline = two_frames();
  TimedWrench next = timed(2 * kFrame_ns, 5);
  next.before_ns = 10 * kFrame_ns;
  EXPECT_TRUE(timeline.push(next));
  EXPECT_TRUE(same_bits(timeline.at(kFrame_ns).wrench, wrench_of(3)));
  EXPECT_TRUE(same_bits(timeline.at(kFrame_ns + 1).wrench, wrench_of(5)));
}

TEST(WrenchTimeline, AMotionAcrossAGapIsThatOfItsFrame) {
  WrenchTimeline timeline;
  timeline.push(timed(0, 1));
  TimedWrench next = timed(10 * kFrame_ns, 2);
  next.before_ns = 5 * kFrame_ns;
  timeline.push(next);
  EXPECT_EQ(timeline.at(10 * kFrame_ns - kRamp_ns - 1).found, Found::kExpired);
  EXPECT_EQ(timeline.at(10 * kFrame_ns).found, Found::kExact);
}

TEST(WrenchTimeline, SpansTheWholeRangeOfTime) {
  WrenchTimeline timeline;
  timeline.push(timed(std::numeric_limits<int64_t>::min(), 0));
  timeline.push(timed(std::numeric_limits<int64_t>::max(), 2));
  EXPECT_EQ(timeline.at(0).found, Found::kExpired);
  const TimelineResult middle = timeline.at(INT64_MAX - kRamp_ns / 2);
  EXPECT_EQ(middle.found, Found::kInterpolated);
  EXPECT_NEAR(middle.wrench.force_N.x(), 0.1, 1e-12);
  timeline.clear();
  timeline.push(timed(std::numeric_limits<int64_t>::min(), 1, 1));
  EXPECT_EQ(timeline.at(std::numeric_limits<int64_t>::max()).found, Found::kExpired);
}

}  // namespace
}  // namespace spidar::test::wrench_timeline_test
