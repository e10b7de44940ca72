// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <initializer_list>

#include "core/track/funscript.h"
#include "tests/support/test.h"
#include "tests/support/written_tracks.h"

namespace spidar::test::funscript_test {
namespace {

/// The own actions of a script in samples, as fractions of what its positions 0 and 100 stand for.
std::vector<TrackSample> read_funscript(const std::string& text, size_t channel) {
  ScriptAxis axis = parse_funscript(text, channel).axes.at(0);
  axis.gain = 1;
  std::vector<TrackSample> samples(static_cast<size_t>(axis.points.back().at_ms) + 1);
  for (size_t i = 0; i < samples.size(); ++i) {
    samples[i][channel] = axis.at(static_cast<int64_t>(i));
  }
  return samples;
}

TEST(Funscript, IsReadAsItWasWritten) {
  std::vector<TrackSample> samples(5000);
  for (size_t i = 0; i < samples.size(); ++i) {
    const double t = 1e-3 * static_cast<double>(i);
    samples[i][4] = static_cast<float>(i % 1000 < 200 ? 0.3 : 0.9 * std::sin(6 * t));
    samples[i][0] = 0.5F;
  }
  const std::vector<TrackSample> read = read_funscript(write_funscript(samples, 4), 4);
  ASSERT_EQ(read.size(), samples.size());
  for (size_t i = 0; i < samples.size(); ++i) {
    // A line differs by 0.01, and its ends by half a step of 1/50.
    ASSERT_NEAR(read[i][4], samples[i][4], 0.02 + 1e-6) << i;
    ASSERT_EQ(read[i][0], 0);
  }
}

// A line over h ms that differs from the curve by e has at most the slope of the curve and 4 e / h
// more; rounding adds one step of 2 % over h. A curve that bends by c in 1/s² leaves a line only
// after h = √(4 e / c).
TEST(Funscript, APlayerMovesAsFastAsTheCurve) {
  constexpr double kPi = 3.14159265358979, kPeriod_s = 4, kAmplitude = 0.3;
  std::vector<TrackSample> samples(10001);
  for (size_t i = 0; i < samples.size(); ++i) {
    const double t_s = 1e-3 * static_cast<double>(i);
    samples[i][0] = static_cast<float>(0.05 * t_s);
    samples[i][1] = static_cast<float>(kAmplitude * std::sin(2 * kPi * t_s / kPeriod_s));
  }
  const double steepest = kAmplitude * 2 * kPi / kPeriod_s;
  const double line_s = std::sqrt(4 * kFunscriptTolerance / (steepest * 2 * kPi / kPeriod_s));
  const double most = steepest + (4 * kFunscriptTolerance + 0.02) / line_s;
  const std::vector<TrackSample> read = read_funscript(write_funscript(samples, 1), 1);
  for (size_t i = 1; i < read.size(); ++i) {
    ASSERT_LE(1000 * std::fabs(read[i][1] - read[i - 1][1]), most + 1e-3) << i;
  }
  const std::string ramp = write_funscript(samples, 0);
  EXPECT_EQ(ramp, R"({"version":"1.0","inverted":false,"range":100,)"
                  R"("gst-spidar":{"channel":0,"gain":1.0},"actions":[{"at":0,"pos":50},)"
                  R"({"at":10000,"pos":75}]})"
                  "\n");
}

TEST(Funscript, PositionsAreJoinedByLines) {
  const auto samples = read_funscript(R"({"actions":[{"at":10,"pos":0},{"at":20,"pos":100}]})", 1);
  ASSERT_EQ(samples.size(), 21u);
  EXPECT_EQ(samples[9][1], 0);
  EXPECT_EQ(samples[10][1], -1);
  EXPECT_NEAR(samples[15][1], 0, 1e-6);
  EXPECT_EQ(samples[20][1], 1);
  const auto inverted =
      read_funscript(R"({"inverted":true,"actions":[{"at":0,"pos":0},{"at":1,"pos":75.5}]})", 1);
  EXPECT_EQ(inverted[0][1], 1);
  EXPECT_NEAR(inverted[1][1], -0.51, 1e-6);
}

TEST(Funscript, OnlyTheRangeIsUsed) {
  const auto read =
      read_funscript(R"({"range":80,"actions":[{"at":0,"pos":0},{"at":1,"pos":100}]})", 1);
  EXPECT_FLOAT_EQ(read[0][1], -0.8F);
  EXPECT_FLOAT_EQ(read[1][1], 0.8F);
  const auto all =
      read_funscript(R"({"range":0,"actions":[{"at":0,"pos":0},{"at":1,"pos":75}]})", 1);
  EXPECT_FLOAT_EQ(all[0][1], -1);
  EXPECT_FLOAT_EQ(all[1][1], 0.5F);
}

TEST(Funscript, ExtremesAreClipped) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinite = std::numeric_limits<float>::infinity();
  const auto read = read_funscript(write_funscript({{0, 3}, {0, nan}, {0, -infinite}}, 1), 1);
  ASSERT_EQ(read.size(), 3u);
  EXPECT_EQ(read[0][1], 1);
  EXPECT_EQ(read[1][1], 0);
  EXPECT_EQ(read[2][1], -1);
}

TEST(Funscript, ItsNotesSayWhatItIsAGainThatLosesItsSamplesIsRefused) {
  const auto noted = [](const std::string& notes) {
    return parse_funscript(
               R"({"gst-spidar":)" + notes + R"(,"actions":[{"at":0,"pos":0},{"at":9,"pos":100}]})",
               1)
        .axes.at(0);
  };
  const ScriptAxis own = noted(R"({"channel":0,"gain":0.5})");
  EXPECT_EQ(own.channel, 0u);
  EXPECT_TRUE(own.is_noted);
  EXPECT_EQ(own.at(9), 2);
  for (const auto& [notes, message] : std::initializer_list<std::pair<const char*, const char*>>{
           {R"({"channel":1,"gain":1e-300})", "gst-spidar.gain is 1e-300, not from 0.001 to 1e+06"},
           {R"({"channel":1,"gain":-1})", "gst-spidar.gain is -1, not from 0.001 to 1e+06"},
           {R"({"channel":6,"gain":1})", "gst-spidar.channel is 6, not from 0 to 5"},
           {R"({"channel":1})", "gst-spidar has no number gain"},
           {"7", "gst-spidar has no number channel"}}) {
    try {
      noted(notes);
      ADD_FAILURE() << notes;
    } catch (const TrackFileError& error) {
      EXPECT_STREQ(error.what(), message);
    }
  }
}

TEST(Funscript, ThoseOfOthersReachTheUsualLimits) {
  const std::string text = R"({"actions":[{"at":0,"pos":0},{"at":9,"pos":100}]})";
  EXPECT_FLOAT_EQ(parse_funscript(text, 1).axes[0].at(9), 0.3F);
  EXPECT_FLOAT_EQ(parse_funscript(text, 5).axes[0].at(0), -0.1F);
}

TEST(Funscript, RestsBeforeAndAfterItsPositions) {
  const ScriptAxis axis =
      parse_funscript(R"({"actions":[{"at":5,"pos":100},{"at":7,"pos":100}]})", 1).axes[0];
  for (const int64_t ms : {-1, 0, 4, 8, 100000}) EXPECT_EQ(axis.at(ms), 0) << ms;
  for (const int64_t ms : {5, 6, 7}) EXPECT_NE(axis.at(ms), 0) << ms;
  EXPECT_EQ(ScriptAxis().at(0), 0);
}

TEST(Funscript, PositionsAreSortedAndTheLaterOfTwoCounts) {
  const auto read = read_funscript(
      R"({"actions":[{"at":9,"pos":100},{"at":5,"pos":1},{"at":-5,"pos":0},{"at":5,"pos":50}]})",
      1);
  ASSERT_EQ(read.size(), 10u);
  EXPECT_EQ(read[0][1], -0.5);
  EXPECT_EQ(read[5][1], 0);
  EXPECT_EQ(read[9][1], 1);
}

TEST(Funscript, HasSeveralAxes) {
  const Funscript first = parse_funscript(R"({"version":"1.1","actions":[{"at":0,"pos":50}],"axes":[
      {"id":"R1","actions":[{"at":0,"pos":100}]},{"id":"V0","actions":[]},{"id":"l2","actions":[]},
      {"id":"R1","inverted":true,"actions":[{"at":0,"pos":100}]}]})",
                                          1);
  ASSERT_EQ(first.axes.size(), 3u);
  EXPECT_EQ(first.axes[1].channel, 5u);
  EXPECT_EQ(first.axes[1].points.at(0).fraction, -1);  // of two, the last
  EXPECT_EQ(first.axes[2].channel, 0u);
  EXPECT_TRUE(first.axes[2].points.empty());
  EXPECT_EQ(first.others, std::vector<std::string>{"V0"});
  const Funscript second = parse_funscript(
      R"({"channels":{"roll":{"actions":[{"at":0,"pos":75}]},"stroke":{"actions":[]},"mist":{}}})",
      1);
  ASSERT_EQ(second.axes.size(), 2u);
  EXPECT_EQ(second.axes[0].channel, 5u);
  EXPECT_EQ(second.axes[0].name, "roll");
  EXPECT_EQ(second.axes[1].channel, 1u);
  EXPECT_EQ(second.others, std::vector<std::string>{"mist"});
}

TEST(Funscript, MistakesAreNamed) {
  const struct {
    const char *text, *message;
  } cases[] = {
      {"", "it is no JSON: it ends too early"},
      {"[]", "it has no actions"},
      {"{}", "it has no actions"},
      {R"({"actions":7})", "actions is no list"},
      {R"({"axes":7})", "axes is no list"},
      {R"({"axes":[{"actions":[]}]})", "axes[0] has no id such as \"R1\""},
      {R"({"axes":[{"id":"R1"}]})", "axes[0] has no actions"},
      {R"({"axes":[{"id":"R1","actions":[{"at":0,"pos":1e308}]}]})",
       "axes[0].actions[0].pos is 1e+308, not from 0 to 100"},
      {R"({"channels":[]})", "channels is no object"},
      {R"({"channels":{"roll":[]}})", "channels.roll has no actions"},
      {R"({"actions":[7]})", "actions[0] has no number at"},
      {R"({"actions":[{"at":"0","pos":0}]})", "actions[0] has no number at"},
      {R"({"actions":[{"at":0}]})", "actions[0] has no number pos"},
      {R"({"actions":[{"at":1e300,"pos":0}]})",
       "actions[0].at is 1e+300, not from -43200000 to 43200000"},
      {R"({"actions":[{"at":0,"pos":101}]})", "actions[0].pos is 101, not from 0 to 100"},
      {R"({"range":101,"actions":[{"at":0,"pos":0}]})",
       "the script.range is 101, not from 0 to 100"},
      {R"({"range":"all","actions":[{"at":0,"pos":0}]})", "the script has no number"},
  };
  for (const auto& [text, message] : cases) {
    SCOPED_TRACE(text);
    try {
      parse_funscript(text, 1);
      ADD_FAILURE() << "no error";
    } catch (const TrackFileError& error) {
      EXPECT_EQ(std::string(error.what()).substr(0, std::string(message).size()), message);
    }
  }
}

}  // namespace
}  // namespace spidar::test::funscript_test
