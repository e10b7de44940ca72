// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Where a player is, from positions as mpv and VLC were measured to tell them.
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "plugin/feel/follow/position_filter.h"

namespace spidar::test::position_filter_test {
namespace {

constexpr int64_t kMs = 1'000'000;
constexpr int64_t kSecond = 1000 * kMs;
constexpr int64_t kBegin = 7'000 * kSecond;

/// How a player tells its position.
struct Habit {
  const char* name;
  int64_t every_ns;
  int64_t earliest_ns, latest_ns;  ///< told so much later than it was reached
};
constexpr Habit kMpv{"mpv", kSecond / 24, -10 * kMs, 12 * kMs};
constexpr Habit kVlc{"VLC", 10 * kSecond / 27, -4 * kMs, 114 * kMs};

/// A player, and what follows it as follow::FollowedFilm does: 100 times a second.
class Followed {
 public:
  explicit Followed(const Habit& habit, double rate = 1) : habit_(habit), rate_(rate) {
    filter_.reset(now_ns_, 0, rate);
    follows_ns_ = 0;
  }

  /// Errors of what follows, in ms.
  std::vector<double> play(int64_t duration_ns) {
    constexpr int64_t kTick = 10 * kMs;
    std::vector<double> errors;
    for (const int64_t end_ns = now_ns_ + duration_ns; now_ns_ < end_ns; now_ns_ += kTick) {
      tell();
      const int64_t error_ns = filter_.position_at(now_ns_) - follows_ns_;
      const int64_t shift_ns = follow::small_correction_ns(error_ns, kTick, false);
      EXPECT_LE(std::abs(shift_ns), kTick / 50);
      follows_ns_ += shift_ns;
      errors.push_back(1e-6 * static_cast<double>(std::abs(follows_ns_ - position_ns_)));
      const int64_t passed_ns = std::llround(static_cast<double>(kTick) * rate_);
      follows_ns_ += passed_ns;
      position_ns_ += passed_ns;
    }
    return errors;
  }
  void jump(int64_t by_ns) { position_ns_ += by_ns; }
  double estimate_error_ms() const {
    return 1e-6 * static_cast<double>(filter_.position_at(now_ns_) - position_ns_);
  }
  follow::PositionFilter& filter() { return filter_; }
  int64_t now_ns() const { return now_ns_; }
  int64_t position_ns() const { return position_ns_; }

 private:
  void tell() {
    if (now_ns_ < next_ns_) return;
    next_ns_ += habit_.every_ns;
    const int64_t late_ns =
        std::uniform_int_distribution<int64_t>(habit_.earliest_ns, habit_.latest_ns)(random_);
    filter_.add(now_ns_, position_ns_ - std::llround(static_cast<double>(late_ns) * rate_));
  }

  const Habit habit_;
  const double rate_;
  std::mt19937 random_{7};
  follow::PositionFilter filter_;
  int64_t now_ns_ = kBegin, next_ns_ = kBegin + kMs;
  int64_t position_ns_ = 0, follows_ns_ = 0;
};

double quantile(std::vector<double> values, double fraction) {
  const auto at = values.begin() + static_cast<long>(fraction * static_cast<double>(values.size()));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

class Players : public testing::TestWithParam<Habit> {};
INSTANTIATE_TEST_SUITE_P(, Players, testing::Values(kMpv, kVlc),
                         [](const auto& each) { return each.param.name; });

// The goal of steady playback.
TEST_P(Players, AreFollowedWithin15MsInTheMedianAnd40At95Percent) {
  for (const double rate : {1.0, 0.5, 2.0}) {
    Followed followed(GetParam(), rate);
    const std::vector<double> errors = followed.play(300 * kSecond);
    EXPECT_LE(quantile(errors, 0.5) / rate, 15) << rate;
    EXPECT_LE(quantile(errors, 0.95) / rate, 40) << rate;
  }
}

// By the second position after it at the latest, told or not.
TEST_P(Players, AreFoundAgainAfterAJump) {
  for (const int64_t by_ns : {10 * kSecond, -4 * kSecond, 400 * kMs, -400 * kMs}) {
    Followed told(GetParam());
    told.play(5 * kSecond);
    told.jump(by_ns);
    told.filter().add_jump(told.now_ns(), told.position_ns());
    EXPECT_NEAR(told.estimate_error_ms(), 0, 1e-3) << by_ns;

    Followed untold(GetParam());
    untold.play(5 * kSecond);
    untold.jump(by_ns);
    untold.play(2 * GetParam().every_ns + 20 * kMs);
    EXPECT_LE(std::abs(untold.estimate_error_ms()),
              1e-6 * static_cast<double>(GetParam().latest_ns))
        << by_ns;
  }
}

// It tells of it when it begins to look for it.
TEST(PositionFilter, WhereAJumpLeadsCountsUntilTheNextPosition) {
  follow::PositionFilter filter;
  filter.reset(kBegin, 0, 1);
  filter.add_jump(kBegin, 20 * kSecond);
  EXPECT_EQ(filter.position_at(kBegin + 50 * kMs), 20 * kSecond + 50 * kMs);
  filter.add(kBegin + 300 * kMs, 20 * kSecond + 250 * kMs);
  EXPECT_EQ(filter.position_at(kBegin + 300 * kMs), 20 * kSecond + 250 * kMs);
}

// A jump to where it is holds VLC up for 80 ms.
TEST(PositionFilter, AJumpOverNothingIsFollowedFromTheNextPositionOn) {
  follow::PositionFilter filter;
  filter.reset(kBegin, 0, 1);
  for (int i = 1; i < 5; ++i) filter.add(kBegin + i * 300 * kMs, i * 300 * kMs);
  filter.add_jump(kBegin + 1300 * kMs, 1300 * kMs);
  filter.add(kBegin + 1600 * kMs, 1520 * kMs);
  EXPECT_EQ(filter.position_at(kBegin + 1600 * kMs), 1520 * kMs);
}

// At the beginning of a film, it first loads.
TEST(PositionFilter, OneThatBeginsLaterThanItSaidIsFoundByItsNextPosition) {
  follow::PositionFilter filter;
  filter.reset(kBegin, 0, 1);
  filter.add(kBegin + kSecond, 40 * kMs);
  EXPECT_EQ(filter.position_at(kBegin + kSecond), 40 * kMs);
}

// What VLC told 0.3 s ago is told until it tells the next one.
TEST(PositionFilter, GoesOnAtAnotherRateFromWhereItIs) {
  follow::PositionFilter filter;
  filter.reset(kBegin, 0, 1);
  filter.add(kBegin + kSecond, kSecond);
  filter.change_rate(kBegin + 1300 * kMs, 2);
  filter.add(kBegin + 1310 * kMs, kSecond);
  EXPECT_EQ(filter.position_at(kBegin + 2300 * kMs), 3300 * kMs);
}

// By then, VLC has told its first position after a jump.
TEST(PositionFilter, TheLargestSmallErrorAfterAJumpIsGoneAfterAQuarterOfASecond) {
  int64_t error_ns = 60 * kMs;
  for (int i = 0; i < 25; ++i) {
    const int64_t shift_ns = follow::small_correction_ns(error_ns, 10 * kMs, true);
    EXPECT_LE(shift_ns, 5 * kMs);
    error_ns -= shift_ns;
  }
  EXPECT_LE(error_ns, 10 * kMs);
}

// VLC says after a pause that it has jumped to the position at which it was paused.
TEST(PositionFilter, AJumpThatWasNoneChangesNothing) {
  follow::PositionFilter filter;
  filter.reset(kBegin, 20 * kSecond, 1);
  filter.add_jump(kBegin + 90 * kMs, 20 * kSecond);
  EXPECT_EQ(filter.position_at(kBegin + kSecond), 21 * kSecond);
}

TEST(PositionFilter, OneThatWasHeldUpAloneChangesNothing) {
  follow::PositionFilter filter;
  filter.reset(kBegin, 0, 1);
  filter.add(kBegin + 500 * kMs, 500 * kMs);
  filter.add(kBegin + kSecond, 600 * kMs);
  EXPECT_EQ(filter.position_at(kBegin + kSecond), kSecond);
  filter.add(kBegin + 2 * kSecond, 2 * kSecond);
  EXPECT_EQ(filter.position_at(kBegin + 2 * kSecond), 2 * kSecond);
}

TEST(PositionFilter, TheSamePositionOnceMoreIsNoNews) {
  follow::PositionFilter filter;
  filter.reset(kBegin, kSecond, 1);
  for (int i = 1; i < 100; ++i) filter.add(kBegin + i * 20 * kMs, kSecond);
  EXPECT_EQ(filter.newest_ns(), kBegin);
  EXPECT_EQ(filter.position_at(kBegin + kSecond), 2 * kSecond);
}

}  // namespace
}  // namespace spidar::test::position_filter_test
