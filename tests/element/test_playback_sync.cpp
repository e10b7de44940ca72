// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Which running time is on the screen at a given time of the haptic loop's clock.
#include <gst/check/gsttestclock.h>

#include "plugin/timing/playback_sync.h"
#include "tests/support/element_harness.h"
#include "tests/support/test.h"

namespace spidar::test::playback_sync_test {
namespace {

constexpr int64_t kSecond = 1'000'000'000;
constexpr int64_t kPeriod = 10'000'000;  // between two readings

struct Sync : testing::Test {
  Sync()
      : clock((init_gstreamer(), gst_test_clock_new())),
        element(GST_ELEMENT(gst_object_ref_sink(gst_bin_new(nullptr)))),
        sync([this] { return monotonic_ns; }) {
    gst_element_set_clock(element, clock);
    gst_element_set_base_time(element, 5 * GST_SECOND);
  }
  ~Sync() override {
    gst_object_unref(element);
    gst_object_unref(clock);
  }

  PlaybackClock observe(int64_t clock_ns) {
    gst_test_clock_set_time(GST_TEST_CLOCK(clock), static_cast<GstClockTime>(clock_ns));
    return sync.observe(element);
  }

  GstClock* clock;
  GstElement* element;
  int64_t monotonic_ns = 100 * kSecond;
  PlaybackSync sync;
};

TEST_F(Sync, IsNotPlayingUntilTold) {
  EXPECT_FALSE(observe(7 * kSecond).playing);
  sync.set_playing(true);
  EXPECT_TRUE(observe(8 * kSecond).playing);
  sync.set_playing(false);
  EXPECT_FALSE(observe(9 * kSecond).playing);
}

TEST_F(Sync, IsNotPlayingWithoutAClock) {
  sync.set_playing(true);
  gst_element_set_clock(element, nullptr);
  EXPECT_FALSE(sync.observe(element).playing);
}

TEST_F(Sync, RunningTimeIsClockLessBaseTimeAndOffset) {
  sync.set_playing(true);
  sync.set_offset(170 * GST_MSECOND);
  const PlaybackClock line = observe(7 * kSecond);
  EXPECT_EQ(line.running_at(monotonic_ns), 2 * kSecond - 170'000'000);
  EXPECT_EQ(line.running_at(monotonic_ns + 5'000'000), 2 * kSecond - 165'000'000);
  sync.set_offset(-30 * GST_MSECOND);
  EXPECT_EQ(observe(7 * kSecond).running_at(monotonic_ns), 2 * kSecond + 30'000'000);
}

TEST_F(Sync, FollowsADriftingClockThroughItsJitter) {
  constexpr double kDrift = 300e-6;
  constexpr double kJitter_ns = 500e3;  // uniform, either way
  std::mt19937 random(1);
  std::uniform_real_distribution<double> jitter(-kJitter_ns, kJitter_ns);
  sync.set_playing(true);
  int64_t clock_ns = 10 * kSecond;
  double worst_ns = 0;
  for (int n = 0; n < 1000; ++n) {
    monotonic_ns += kPeriod;
    const double true_ns = 10e9 + static_cast<double>(n) * kPeriod * (1 + kDrift);
    // A clock never goes back.
    clock_ns = std::max(clock_ns, static_cast<int64_t>(true_ns + jitter(random)));
    const PlaybackClock line = observe(clock_ns);
    if (n < 64) continue;
    // At the next reading: the loop works with this line until then.
    const double expected_ns = true_ns - 5e9 + kPeriod * (1 + kDrift);
    worst_ns = std::max(
        worst_ns,
        std::fabs(static_cast<double>(line.running_at(monotonic_ns + kPeriod)) - expected_ns));
  }
  // The end of a line through n readings has a standard deviation of 2 σ/√n; σ = jitter/√3, n = 64,
  // and of 936 lines the worst is within four of them.
  EXPECT_LT(worst_ns, 4 * 2 * kJitter_ns / std::sqrt(3.0) / 8);
}

TEST_F(Sync, StaysWithASoundCardThatDrifts) {
  constexpr double kDrift = 300e-6;
  constexpr int64_t kSamples_s = 48'000;
  constexpr int64_t kTenMinutes = 600 * kSecond / kPeriod;
  sync.set_playing(true);
  const auto true_ns = [](int64_t n) { return static_cast<double>(n * kPeriod) * (1 + kDrift); };
  double least_ns = 0;
  double most_ns = 0;
  for (int64_t n = 0; n < kTenMinutes; ++n) {
    monotonic_ns += kPeriod;
    // The clock is what the card has played, in whole samples.
    const auto samples = static_cast<int64_t>(1e-9 * true_ns(n) * kSamples_s);
    const PlaybackClock line = observe(10 * kSecond + samples * kSecond / kSamples_s);
    if (n < 64) continue;
    const double running_ns = static_cast<double>(line.running_at(monotonic_ns + kPeriod));
    const double error_ns = running_ns - (5e9 + true_ns(n + 1));
    least_ns = std::min(least_ns, error_ns);
    most_ns = std::max(most_ns, error_ns);
  }
  // A reading is 0 … 1 sample behind: 1/2 ± 1/2. At the end of a least squares line the sizes of
  // the weights of many readings add up to 5/3, one period further to 3 % more, and of what they
  // stand for to 1. In the end the clock is 180 ms ahead.
  const double sample_ns = 1e9 / kSamples_s;
  EXPECT_LT(most_ns, (-0.5 + 0.5 * 5 / 3 * 1.05) * sample_ns);
  EXPECT_GT(least_ns, (-0.5 - 0.5 * 5 / 3 * 1.05) * sample_ns);
}

TEST_F(Sync, LeavesOutAFewReadingsThatStray) {
  sync.set_playing(true);
  for (int n = 0; n < 200; ++n) {
    monotonic_ns += kPeriod;
    const int64_t clock_ns = 10 * kSecond + n * kPeriod;
    // From 30 on four of ten show the time of the one before them.
    const bool stands_still = n >= 30 && n % 10 < 4;
    const PlaybackClock line = observe(stands_still ? clock_ns - (n % 10 + 1) * kPeriod : clock_ns);
    EXPECT_EQ(line.running_at(monotonic_ns), clock_ns - 5 * kSecond) << n;
  }
}

TEST_F(Sync, FollowsAJumpThatLasts) {
  sync.set_playing(true);
  for (int n = 0; n < 100; ++n) {
    monotonic_ns += kPeriod;
    observe(10 * kSecond + n * kPeriod);
  }
  for (int n = 0; n < 4; ++n) {
    monotonic_ns += kPeriod;
    EXPECT_EQ(observe(20 * kSecond + n * kPeriod).running_at(monotonic_ns),
              6 * kSecond + n * kPeriod);
  }
  monotonic_ns += kPeriod;
  EXPECT_EQ(observe(20 * kSecond + 4 * kPeriod).running_at(monotonic_ns),
            15 * kSecond + 4 * kPeriod);
}

TEST_F(Sync, FollowsAJumpAtOnceWhileTheClockIsNew) {
  sync.set_playing(true);
  for (int n = 0; n < 5; ++n) {  // a sound card that has not begun to play
    monotonic_ns += kPeriod;
    EXPECT_EQ(observe(10 * kSecond).running_at(monotonic_ns), 5 * kSecond);
  }
}

TEST_F(Sync, AnotherClockIsFollowedFromItsFirstReading) {
  sync.set_playing(true);
  for (int n = 0; n < 100; ++n) {
    monotonic_ns += kPeriod;
    observe(10 * kSecond + n * kPeriod);
  }
  // 3 ms from where the other one would be: no jump that would be seen as one.
  gst_object_unref(clock);
  clock = gst_test_clock_new();
  gst_element_set_clock(element, clock);
  monotonic_ns += kPeriod;
  const int64_t other_ns = 10 * kSecond + 100 * kPeriod + 3'000'000;
  EXPECT_EQ(observe(other_ns).running_at(monotonic_ns), other_ns - 5 * kSecond);
}

TEST_F(Sync, AfterAFlushNothingIsShownUntilThereIsANewBaseTime) {
  sync.set_playing(true);
  EXPECT_TRUE(observe(10 * kSecond).playing);
  sync.expect_base_time(element);
  monotonic_ns += kSecond;
  EXPECT_FALSE(observe(11 * kSecond).playing);
  gst_element_set_base_time(element, 11 * GST_SECOND);
  const PlaybackClock line = observe(11 * kSecond);
  EXPECT_TRUE(line.playing);
  EXPECT_EQ(line.running_at(monotonic_ns), 0);
}

TEST_F(Sync, ASinkThatKeepsItsBaseTimeIsAcceptedAfterAWhile) {
  sync.set_playing(true);
  observe(10 * kSecond);
  sync.expect_base_time(element);
  monotonic_ns += 2 * kSecond;
  EXPECT_FALSE(observe(12 * kSecond).playing);
  monotonic_ns += 2 * kSecond;
  EXPECT_TRUE(observe(14 * kSecond).playing);
}

constexpr int64_t kLongest = PlaybackSync::kLongestStandstill_ns;

TEST_F(Sync, AClockThatStandsStillIsFollowedForAsLongAsAFrameIsHeld) {
  sync.set_playing(true);
  for (int n = 0; n < 50; ++n) {
    monotonic_ns += kPeriod;
    EXPECT_TRUE(observe(10 * kSecond + n * kPeriod).plays_at(monotonic_ns + kPeriod)) << n;
  }
  const int64_t standing_ns = 10 * kSecond + 49 * kPeriod;
  const int64_t last_progress_ns = monotonic_ns;
  for (int n = 0; n < 600; ++n) {
    monotonic_ns += kPeriod;
    const PlaybackClock line = observe(standing_ns);
    const int64_t stands_for_ns = monotonic_ns - last_progress_ns;
    EXPECT_EQ(line.plays_at(monotonic_ns), stands_for_ns < kLongest) << stands_for_ns;
  }
  // It has gone on for twice the time at the next reading but one.
  for (int n = 1; n <= 10; ++n) {
    monotonic_ns += kPeriod;
    EXPECT_TRUE(observe(standing_ns + n * kPeriod).plays_at(monotonic_ns)) << n;
  }
}

TEST_F(Sync, AClockThatCannotBeReadIsTrustedForAsLongAsAFrameIsHeld) {
  sync.set_playing(true);
  const PlaybackClock line = observe(10 * kSecond);
  EXPECT_TRUE(line.plays_at(monotonic_ns + kLongest - 1));
  EXPECT_FALSE(line.plays_at(monotonic_ns + kLongest));
}

TEST_F(Sync, AClockBelowHalfTheSpeedCountsAsStopped) {
  for (const int percent : {40, 60}) {
    SCOPED_TRACE(percent);
    sync.set_playing(true);
    PlaybackClock line;
    for (int n = 0; n < 200; ++n) {
      monotonic_ns += kPeriod;
      line = observe(20 * kSecond * percent + n * kPeriod * percent / 100);
    }
    EXPECT_EQ(line.plays_at(monotonic_ns), percent > 50);
  }
}

TEST_F(Sync, ACardThatIsReadInWholePeriodsDoesNotStandStill) {
  sync.set_playing(true);
  constexpr int64_t kCardPeriod = 4 * kPeriod;
  for (int n = 0; n < 200; ++n) {
    monotonic_ns += kPeriod;
    const PlaybackClock line = observe(10 * kSecond + n * kPeriod / kCardPeriod * kCardPeriod);
    EXPECT_TRUE(line.plays_at(monotonic_ns + kPeriod)) << n;
  }
}

}  // namespace
}  // namespace spidar::test::playback_sync_test
