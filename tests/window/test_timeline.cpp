// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The timeline of the last minute: recording, pausing, and looking back.
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "plugin/window/program/model/timeline.h"

namespace spidar::test::timeline_test {
namespace {

constexpr double kRounding = 1e-9;

Moment moment(double time_s, double speed_px_s = 10) {
  Moment made;
  made.time_s = time_s;
  made.speed_px_s = speed_px_s;
  return made;
}

void add_still(Timeline& timeline, double time_s) {
  auto still = std::make_shared<Still>();
  still->time_s = time_s;
  timeline.add_still(std::move(still));
}

/// A moment every tenth of a second, a picture where one is due.
void record(Timeline& timeline, int first, int last) {
  for (int i = first; i <= last; ++i) {
    timeline.add(moment(0.1 * i));
    if (timeline.wants_still(0.1 * i)) add_still(timeline, 0.1 * i);
  }
}

TEST(Timeline, RemembersAMinuteAndPlotsItsLastFiveSeconds) {
  Timeline timeline;
  EXPECT_TRUE(timeline.plotted().empty());
  EXPECT_EQ(timeline.cursor_s(), 0);
  record(timeline, 0, 1000);
  EXPECT_NEAR(timeline.moments().front().time_s, 40, kRounding + 0.1);
  EXPECT_NEAR(timeline.cursor_s(), 100, kRounding);
  EXPECT_NEAR(timeline.plotted().first->time_s, 95, kRounding + 0.1);
  EXPECT_EQ(&timeline.plotted().back(), &timeline.moments().back());
}

TEST(Timeline, PlotsMoreOrFewerSecondsWithinBounds) {
  Timeline timeline;
  record(timeline, 0, 1000);
  timeline.zoom(2);
  EXPECT_NEAR(timeline.plotted().first->time_s, 90, kRounding + 0.1);
  timeline.zoom(0.25);
  EXPECT_NEAR(timeline.plotted().first->time_s, 97.5, kRounding + 0.1);
  timeline.zoom(1e-9);
  EXPECT_EQ(timeline.plotted_s(), Timeline::kLeastPlotted_s);
  timeline.zoom(1e9);
  EXPECT_EQ(timeline.plotted_s(), Timeline::kMostPlotted_s);
  timeline.forget();
  EXPECT_EQ(timeline.plotted_s(), Timeline::kMostPlotted_s) << "the choice stays";
}

TEST(Timeline, TheLargestSpeedStaysUntilItForgets) {
  Timeline timeline;
  timeline.add(moment(0, 500));
  record(timeline, 1, 1000);
  EXPECT_EQ(timeline.largest_speed_px_s(), 500) << "also when it is not shown any more";
  timeline.forget();
  EXPECT_TRUE(timeline.moments().empty());
  EXPECT_EQ(timeline.largest_speed_px_s(), 0);
}

TEST(Timeline, APauseHoldsTheViewAndRecordsOn) {
  Timeline timeline;
  record(timeline, 0, 100);
  timeline.pause();
  record(timeline, 101, 200);
  EXPECT_TRUE(timeline.is_paused());
  EXPECT_NEAR(timeline.cursor_s(), 10, kRounding);
  EXPECT_EQ(timeline.moments().size(), 101u);
  EXPECT_NEAR(timeline.plotted().back().time_s, 10, kRounding);
  timeline.pause();  // again: the view stays
  EXPECT_NEAR(timeline.cursor_s(), 10, kRounding);
  timeline.resume();
  EXPECT_FALSE(timeline.is_paused());
  ASSERT_EQ(timeline.moments().size(), 201u) << "without a gap";
  EXPECT_NEAR(timeline.cursor_s(), 20, kRounding);
}

TEST(Timeline, LooksAtAnyTimeOfTheMinute) {
  Timeline timeline;
  timeline.look_at(3);
  EXPECT_FALSE(timeline.is_paused()) << "there is nothing to look at";
  record(timeline, 0, 300);
  timeline.look_at(12.34);
  EXPECT_TRUE(timeline.is_paused());
  EXPECT_NEAR(timeline.cursor_s(), 12.34, kRounding);
  EXPECT_NEAR(timeline.plotted().back().time_s, 12.3, kRounding) << "the moment before";
  EXPECT_NEAR(timeline.plotted().first->time_s, 7.4, kRounding);
  timeline.look_at(-5);
  EXPECT_EQ(timeline.cursor_s(), 0);
  ASSERT_FALSE(timeline.plotted().empty());
  timeline.look_at(1e9);
  EXPECT_NEAR(timeline.cursor_s(), 30, kRounding);
}

TEST(Timeline, KeepsAPictureEveryQuarterOfASecond) {
  Timeline timeline;
  EXPECT_TRUE(timeline.wants_still(0));
  record(timeline, 0, 1000);
  EXPECT_EQ(timeline.still(), nullptr) << "live there is the picture itself";
  timeline.look_at(70.05);
  ASSERT_NE(timeline.still(), nullptr);
  EXPECT_LE(timeline.still()->time_s, 70.05);
  // A moment each 0.1 s: pictures 0.3 s apart.
  EXPECT_GT(timeline.still()->time_s, 70.05 - 0.3 - kRounding);
  timeline.look_at(0);
  ASSERT_NE(timeline.still(), nullptr);
  EXPECT_GE(timeline.still()->time_s, 40 - kRounding) << "a minute of them";
}

TEST(Timeline, AnotherStreamDoesNotTakeAwayAPausedView) {
  Timeline timeline;
  record(timeline, 0, 100);
  timeline.look_at(5);
  timeline.forget();
  EXPECT_EQ(timeline.moments().size(), 101u);
  EXPECT_NE(timeline.still(), nullptr);
  timeline.resume();
  EXPECT_TRUE(timeline.moments().empty());
}

/// A force of 2 N to the right, which drops to nothing for 40 ms at 0.5 s.
void add_ticks(Timeline& timeline) {
  for (int ms = 0; ms < 1000; ++ms) {
    ForceTick tick;
    tick.monotonic_ns = int64_t{1'000'000} * ms;
    tick.wanted_N.x() = 2;
    tick.delivered_N.x() = ms >= 500 && ms < 540 ? 0 : 2;
    timeline.add(tick);
  }
}

TEST(Timeline, AForceHasTheLowestAndHighestOfTheMillisecondsOfEachColumn) {
  Timeline timeline;
  add_ticks(timeline);
  // 10 ms each: the edges of the drop are in the columns 50 and 54.
  const std::vector<ForceColumn> columns = timeline.columns(0, 1, 100);
  for (size_t i = 0; i < columns.size(); ++i) {
    ASSERT_FALSE(columns[i].is_empty) << i;
    EXPECT_EQ(columns[i].wanted_low_N.x(), 2) << i;
    EXPECT_EQ(columns[i].delivered_low_N.x(), i >= 50 && i <= 54 ? 0 : 2) << i;
    EXPECT_EQ(columns[i].delivered_high_N.x(), i > 50 && i < 54 ? 0 : 2) << i;
  }
  EXPECT_EQ(columns[52].most_N, 0);
}

TEST(Timeline, AColumnWithoutATickContinuesTheOneBeforeExceptInAGap) {
  Timeline timeline;
  for (const int64_t ms : {0, 100, 200, 900}) {
    ForceTick tick;
    tick.monotonic_ns = 1'000'000 * ms;
    tick.delivered_N.x() = static_cast<double>(ms);
    timeline.add(tick);
  }
  const std::vector<ForceColumn> columns = timeline.columns(0, 1, 20);  // of 50 ms
  EXPECT_EQ(columns[1].delivered_high_N.x(), 0);
  EXPECT_EQ(columns[3].delivered_high_N.x(), 100);
  EXPECT_TRUE(columns[10].is_empty) << "nothing is known of 0.7 s";
  EXPECT_EQ(columns[18].delivered_low_N.x(), 900);
}

TEST(Still, AveragesSquares) {
  // 5 × 4 pixels in rows of 24 bytes, made no wider than 2: squares of 3, what is left is left out.
  std::vector<uint8_t> rgba(4 * 24, 255);
  for (size_t y = 0; y < 4; ++y) {
    for (size_t x = 0; x < 5; ++x) {
      const size_t i = 24 * y + 4 * x;
      rgba[i] = static_cast<uint8_t>(10 * x);
      rgba[i + 1] = static_cast<uint8_t>(20 * y);
      rgba[i + 2] = 7;
    }
  }
  Still still;
  shrink_into(still, rgba.data(), 5, 4, 24, 2);
  EXPECT_EQ(still.width, 1);
  EXPECT_EQ(still.height, 1);
  EXPECT_EQ(still.rgba, (std::vector<uint8_t>{10, 20, 7, 255}));
  shrink_into(still, rgba.data(), 5, 4, 24, 5);
  EXPECT_EQ(still.width, 5);
  EXPECT_EQ(still.height, 4);
  EXPECT_EQ(still.rgba[4 * 7], 20) << "as it is: x 2, y 1";
  shrink_into(still, rgba.data(), 5, 1, 24, 1);
  EXPECT_EQ(still.width, 1);
  EXPECT_EQ(still.height, 1);
  EXPECT_EQ(still.rgba[0], 20) << "lower than its squares: the mean of the row";
}

}  // namespace
}  // namespace spidar::test::timeline_test
