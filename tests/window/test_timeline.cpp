// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The timeline of the last minute.
#include "plugin/window/program/model/timeline.h"
#include "tests/support/test.h"

namespace spidar::test::timeline_test {
namespace {

constexpr double kRounding = 1e-9;

window::Moment moment(double time_s, double speed_px_s = 10) {
  window::Moment made;
  made.time_s = time_s;
  made.speed_px_s = speed_px_s;
  return made;
}

/// A moment every tenth of a second.
void record(window::Timeline& timeline, int first, int last) {
  for (int i = first; i <= last; ++i) timeline.add(moment(0.1 * i));
}

TEST(AreSame, AreForcesWhoseNumberAReaderCannotTellApart) {
  const auto force = [](double x_N, double y_N) {
    Wrench wrench;
    wrench.force_N = {x_N, y_N, 0};
    return wrench;
  };
  EXPECT_TRUE(window::are_same(force(1.8, 0), force(0, 1.8)))
      << "else \"1.8 N wanted\" and \"1.8 N\"";
  EXPECT_TRUE(window::are_same(force(1.76, 0), force(1.84, 0)));
  EXPECT_FALSE(window::are_same(force(1.84, 0), force(1.86, 0))) << "1.8 N and 1.9 N";
}

TEST(Timeline, RemembersAMinuteAndPlotsItsLastFiveSeconds) {
  window::Timeline timeline;
  EXPECT_TRUE(timeline.plotted().empty());
  EXPECT_EQ(timeline.newest_s(), 0);
  record(timeline, 0, 1000);
  EXPECT_NEAR(timeline.moments().front().time_s, 40, kRounding + 0.1);
  EXPECT_NEAR(timeline.newest_s(), 100, kRounding);
  EXPECT_NEAR(timeline.plotted().front().time_s, 95, kRounding + 0.1);
  EXPECT_EQ(timeline.plotted().back().time_s, timeline.moments().back().time_s);
}

TEST(Timeline, PlotsMoreOrFewerSecondsWithinBounds) {
  window::Timeline timeline;
  record(timeline, 0, 1000);
  timeline.zoom(2);
  EXPECT_NEAR(timeline.plotted().front().time_s, 90, kRounding + 0.1);
  timeline.zoom(0.25);
  EXPECT_NEAR(timeline.plotted().front().time_s, 97.5, kRounding + 0.1);
  timeline.zoom(1e-9);
  EXPECT_EQ(timeline.plotted_s(), window::Timeline::kMinPlotted_s);
  timeline.zoom(1e9);
  EXPECT_EQ(timeline.plotted_s(), window::Timeline::kMaxPlotted_s);
  timeline.clear();
  EXPECT_EQ(timeline.plotted_s(), window::Timeline::kMaxPlotted_s) << "the choice stays";
}

TEST(Timeline, TheLargestSpeedStaysUntilAnotherStreamForgetsAll) {
  window::Timeline timeline;
  timeline.add(moment(0, 500));
  record(timeline, 1, 1000);
  timeline.add(ForceTick{1'000'000'000, {1, 0, 0}});
  ControllerSettings linear;
  linear.law = ControlLaw::kLinear;
  const auto at_250_px_s = [&] { return timeline.gain_curve(linear, 250, 2)[1]; };
  // Eq. 12 and 13: in proportion to the largest speed, which is not shown any more.
  EXPECT_NEAR(at_250_px_s(), linear.max_force_N / 2, kRounding);
  timeline.clear();
  EXPECT_TRUE(timeline.moments().empty());
  EXPECT_TRUE(timeline.columns(0, 2, 1)[0].is_empty);
  EXPECT_NEAR(at_250_px_s(), linear.max_force_N, kRounding) << "it is the largest now";
}

/// A force of 2 N to the right, which drops to nothing for 40 ms at 0.5 s.
void add_ticks(window::Timeline& timeline) {
  for (int ms = 0; ms < 1000; ++ms) {
    ForceTick tick;
    tick.monotonic_ns = int64_t{1'000'000} * ms;
    tick.wanted_N.x() = 2;
    tick.delivered_N.x() = ms >= 500 && ms < 540 ? 0 : 2;
    timeline.add(tick);
  }
}

TEST(Timeline, AForceHasTheLowestAndHighestOfTheMillisecondsOfEachColumn) {
  window::Timeline timeline;
  add_ticks(timeline);
  // 10 ms each: the edges of the drop are in the columns 50 and 54.
  const std::vector<window::ForceColumn> columns = timeline.columns(0, 1, 100);
  for (size_t i = 0; i < columns.size(); ++i) {
    ASSERT_FALSE(columns[i].is_empty) << i;
    EXPECT_EQ(columns[i].wanted_low_N.x(), 2) << i;
    EXPECT_EQ(columns[i].delivered_low_N.x(), i >= 50 && i <= 54 ? 0 : 2) << i;
    EXPECT_EQ(columns[i].delivered_high_N.x(), i > 50 && i < 54 ? 0 : 2) << i;
  }
  EXPECT_EQ(columns[52].most_N, 0);
}

TEST(Timeline, AColumnWithoutATickContinuesTheOneBeforeExceptInAGap) {
  window::Timeline timeline;
  for (const int64_t ms : {0, 100, 200, 900}) {
    ForceTick tick;
    tick.monotonic_ns = 1'000'000 * ms;
    tick.delivered_N.x() = static_cast<double>(ms);
    timeline.add(tick);
  }
  const std::vector<window::ForceColumn> columns = timeline.columns(0, 1, 20);  // of 50 ms
  EXPECT_EQ(columns[1].delivered_high_N.x(), 0);
  EXPECT_EQ(columns[3].delivered_high_N.x(), 100);
  EXPECT_TRUE(columns[10].is_empty) << "nothing is known of 0.7 s";
  EXPECT_EQ(columns[18].delivered_low_N.x(), 900);
}

TEST(Timeline, BeginsWithWhatThereIsInFewRoundSteps) {
  window::Timeline timeline;
  EXPECT_EQ(timeline.remembered_s(), 5) << "what the plots show";
  for (const auto& [at_s, remembered_s] : {std::pair{100.0, 5.0},
                                           {104.9, 5.0},
                                           {105.1, 10.0},
                                           {118.0, 20.0},
                                           {131.0, 60.0},
                                           {190.0, 60.0}}) {
    window::Moment moment;
    moment.time_s = at_s;
    timeline.add(moment);
    EXPECT_EQ(timeline.remembered_s(), remembered_s) << at_s;
  }
  timeline.clear();
  timeline.zoom(4);
  EXPECT_EQ(timeline.remembered_s(), 20) << "never less than the plots show";
}

}  // namespace
}  // namespace spidar::test::timeline_test
