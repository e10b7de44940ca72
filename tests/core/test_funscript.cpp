// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/track/funscript.h"

namespace spidar::test::funscript_test {
namespace {

TEST(Funscript, IsReadAsItWasWritten) {
  std::vector<TrackSample> samples(5000);
  for (size_t i = 0; i < samples.size(); ++i) {
    const double t = 1e-3 * static_cast<double>(i);
    samples[i][4] = static_cast<float>(i % 1000 < 200 ? 0.3 : 0.9 * std::sin(6 * t));
    samples[i][0] = 0.5F;
  }
  const std::vector<TrackSample> read = read_funscript(write_funscript(samples, 4), 2);
  ASSERT_EQ(read.size(), samples.size());
  for (size_t i = 0; i < samples.size(); ++i) {
    // Half a step of 1/50.
    ASSERT_NEAR(read[i][2], samples[i][4], 0.01 + 1e-6) << i;
    ASSERT_EQ(read[i][0], 0);
  }
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

TEST(Funscript, ExtremesAreClipped) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const auto read = read_funscript(write_funscript({{0, 3}, {0, nan}, {0, -3}}, 1), 1);
  ASSERT_EQ(read.size(), 3u);
  EXPECT_EQ(read[0][1], 1);
  EXPECT_EQ(read[1][1], 0);
  EXPECT_EQ(read[2][1], -1);
}

TEST(Funscript, MistakesAreNamed) {
  const struct {
    const char *text, *message;
  } cases[] = {
      {"", "funscript: no JSON: "},
      {"[]", "funscript: it has no actions"},
      {"{}", "funscript: it has no actions"},
      {R"({"actions":7})", "funscript: it has no actions"},
      {R"({"actions":[]})", "funscript: it has no actions"},
      {R"({"actions":[7]})", "funscript: actions[0] has no number at"},
      {R"({"actions":[{"at":"0","pos":0}]})", "funscript: actions[0] has no number at"},
      {R"({"actions":[{"at":0}]})", "funscript: actions[0] has no number pos"},
      {R"({"actions":[{"at":-1,"pos":0}]})", "funscript: actions[0].at is -1, not from 0 to"},
      {R"({"actions":[{"at":1e300,"pos":0}]})", "funscript: actions[0].at is 1e+300, not from 0"},
      {R"({"actions":[{"at":0,"pos":101}]})",
       "funscript: actions[0].pos is 101, not from 0 to 100"},
      {R"({"actions":[{"at":5,"pos":1},{"at":5,"pos":2}]})",
       "funscript: actions[1] is not after the one before"},
  };
  for (const auto& [text, message] : cases) {
    SCOPED_TRACE(text);
    try {
      read_funscript(text, 1);
      ADD_FAILURE() << "no error";
    } catch (const FunscriptError& error) {
      EXPECT_EQ(std::string(error.what()).substr(0, std::string(message).size()), message);
    }
  }
}

}  // namespace
}  // namespace spidar::test::funscript_test
