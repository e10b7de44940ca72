// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The statistics that the player collects: quantiles, curves, skew.

#include <cmath>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "apps/play/histogram.h"
#include "apps/play/series.h"
#include "apps/play/skew.h"
#include "apps/play/summary.h"
#include "apps/play/unfelt.h"

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

template <size_t N>
std::vector<std::vector<double>> rows_of(const Series<N>& series) {
  std::stringstream text;
  series.write(text);
  std::vector<std::vector<double>> rows;
  for (std::string line; std::getline(text, line);) {
    std::istringstream numbers(line);
    rows.emplace_back();
    for (double number; numbers >> number;) rows.back().push_back(number);
  }
  return rows;
}

TEST(Series, KeepsAShortOneAsItIs) {
  Series<2> series;
  series.add(0.0, {1, -1});
  series.add(0.5, {2, -2});
  const std::vector<std::vector<double>> expected = {{0, 1, -1}, {0.5, 2, -2}};
  EXPECT_EQ(rows_of(series), expected);
}

TEST(Series, ALongOneStaysSmallAndKeepsItsPeak) {
  Series<1> series;
  constexpr int kSamples = 1'000'000;
  for (int i = 0; i < kSamples; ++i) series.add(0.001 * i, {i == 123'456 ? 5.0 : 0.0});
  const auto rows = rows_of(series);
  EXPECT_LE(rows.size(), 2u * 8000u);
  EXPECT_GE(rows.size(), 2000u);
  double peak = 0;
  double peak_s = 0;
  double last_s = -1;
  for (const auto& row : rows) {
    EXPECT_GE(row[0], last_s);
    last_s = row[0];
    if (row[1] > peak) {
      peak = row[1];
      peak_s = row[0];
    }
  }
  EXPECT_EQ(peak, 5.0);
  // Bins double from a millisecond until 8000 of them span the 1000 s: at most 0.25 s wide, twice
  // that while they fill, and they are named after their first sample.
  EXPECT_NEAR(peak_s, 123.456, 0.5);
}

TEST(Unfelt, SaysNothingWhenEverythingIsFelt) {
  EXPECT_EQ(unfelt_text({{"none", 100}}, "none"), "");
  EXPECT_EQ(unfelt_text({}, ""), "");
}

TEST(Unfelt, IsOneSentenceWhenThereIsOneReason) {
  EXPECT_EQ(unfelt_text({{"nothing-moves", 100}}, "nothing-moves"),
            "Nothing was felt: Nothing moves in the picture.\n");
}

TEST(Unfelt, LeavesOutWhatWasBeforePlaying) {
  EXPECT_EQ(unfelt_text({{"not-playing", 3}, {"device-starting", 2}, {"muted", 100}}, "muted"),
            "Nothing was felt: The force is muted (mute=true).\n");
  EXPECT_EQ(unfelt_text({{"not-playing", 3}, {"none", 100}}, "none"), "");
}

TEST(Unfelt, ListsTheMostFrequentReasonFirstAndTheLastOneAtTheEnd) {
  EXPECT_EQ(unfelt_text({{"none", 499}, {"muted", 100}, {"nothing-moves", 400}, {"late", 1}},
                        "nothing-moves"),
            "Nothing was felt in 50.1 % of the frames:\n"
            "40.0 %  Nothing moves in the picture.\n"
            "10.0 %  The force is muted (mute=true).\n"
            "Nothing was felt in the last second: Nothing moves in the picture.\n");
}

TEST(Unfelt, PrintsAnUnknownReasonUnchanged) {
  EXPECT_EQ(unfelt_text({{"new-reason", 2}}, "new-reason"), "Nothing was felt: new-reason\n");
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

/// Ten seconds at 30 frames/s in which the force is 1 N three quarters of the time.
SessionRecord::Numbers numbers_of_ten_seconds() {
  SessionRecord::Numbers numbers;
  numbers.duration_s = 10;
  numbers.frames = 300;
  numbers.shown = 299;
  numbers.ticks = 10000;
  numbers.felt_ticks = 7500;
  for (int i = 0; i < 4; ++i) numbers.delivered_N.add(i == 0 ? 0.0 : 1.0);
  numbers.skew.shown(0, 1'000'000);
  numbers.skew.felt(0, 1'400'000);
  return numbers;
}

TEST(Summary, IsFiveLinesOfWhatAPersonWants) {
  ElementFacts facts;
  facts.analysis_ms_median = 0.31;
  facts.analysis_ms_max = 1.2;
  facts.device = "sim";
  facts.device_state = "running";
  // Quantiles are within half a bin of 1 %; the values are rounded to two digits.
  EXPECT_EQ(summary_text(numbers_of_ten_seconds(), facts),
            "Video: 10.0 s, 300 frames, 299 of them shown.\n"
            "Force: 1.00 N in the median, 1.00 N at most; 75 % of the time a hand feels it.\n"
            "In time: force and picture are 0.40 ms apart in the median, 0.40 ms at 99 %.\n"
            "Analysis: 0.31 ms a frame in the median, 1.20 ms at most.\n"
            "Device: sim, no problems found.\n");
}

TEST(Summary, SaysThatATrackWasPlayed) {
  ElementFacts facts;
  facts.track_frames = 300;
  const std::string text = summary_text(numbers_of_ten_seconds(), facts);
  EXPECT_NE(text.find("Analysis: none of 300 frames, whose force is that of a haptic track.\n"),
            std::string::npos)
      << text;
}

TEST(Summary, NamesTheProblemsOfTheDevice) {
  ElementFacts facts;
  facts.device = "usb";
  facts.device_state = "lost";
  facts.times_lost = 2;
  facts.exchange_errors = 21;
  facts.faulty_string = 4;
  facts.pose_trouble = "the string lengths fit no pose";
  facts.refused_wrenches = 3;
  const std::string text = summary_text(numbers_of_ten_seconds(), facts);
  for (const char* problem :
       {"it does not answer", "lost 2 times", "21 exchanges failed", "string 4",
        "the pose is not known: the string lengths", "of 3 frames was not rendered"}) {
    EXPECT_NE(text.find(problem), std::string::npos) << problem << "\n" << text;
  }
  EXPECT_EQ(text.find("no problems"), std::string::npos);
}

TEST(Summary, SaysWhatWasNotMeasured) {
  SessionRecord::Numbers numbers;
  numbers.frames = 5;
  const std::string text = summary_text(numbers, {});
  EXPECT_NE(text.find("Force: none"), std::string::npos) << text;
  EXPECT_NE(text.find("In time: not measured"), std::string::npos) << text;
  EXPECT_NE(text.find("Device: none."), std::string::npos) << text;
  EXPECT_EQ(text.find("nan"), std::string::npos) << text;
}

}  // namespace
