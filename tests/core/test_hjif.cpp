// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <nlohmann/json.hpp>

#include "core/track/exchange_formats.h"
#include "tests/support/test.h"
#include "tests/support/written_tracks.h"

namespace spidar::test::hjif_test {
namespace {

std::vector<TrackSample> track(size_t count, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> phase(0, 6.28);
  std::vector<TrackSample> samples(count);
  for (size_t channel = 0; channel < kTrackChannels; ++channel) {
    const double p = phase(random), q = phase(random);
    for (size_t i = 0; i < count; ++i) {
      const double t = 1e-3 * static_cast<double>(i);
      // Frames at 25/s and what they move, with rest between.
      const double value = std::sin(0.3 * t + p) > 0.2 ? 0.3 * std::sin(7 * t + q) : 0;
      samples[i][channel] = static_cast<float>(value);
    }
  }
  return samples;
}

double largest_error(const std::vector<TrackSample>& a, const std::vector<TrackSample>& b) {
  double largest = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    for (size_t k = 0; k < kTrackChannels; ++k) {
      largest = std::max(largest, std::fabs(static_cast<double>(a[i][k]) - b[i][k]));
    }
  }
  return largest;
}

TEST(Keyframes, PassEveryValueWithinTheToleranceAndAreFew) {
  std::vector<double> values;
  for (int i = 0; i < 2000; ++i) values.push_back(std::sin(0.01 * i));
  for (const double tolerance : {1e-4, 1e-3, 1e-2}) {
    const std::vector<size_t> chosen = choose_keyframes(values, tolerance);
    ASSERT_EQ(chosen.front(), 0u);
    ASSERT_EQ(chosen.back(), values.size() - 1);
    for (size_t k = 1; k < chosen.size(); ++k) {
      const size_t a = chosen[k - 1], b = chosen[k];
      ASSERT_LT(a, b);
      for (size_t i = a; i <= b; ++i) {
        const double s = static_cast<double>(i - a) / static_cast<double>(b - a);
        ASSERT_LE(std::fabs(values[a] + s * (values[b] - values[a]) - values[i]),
                  tolerance * (1 + 1e-9));
      }
    }
    // A line within the tolerance of an arc of curvature c is √(8 tolerance / c) long at least, and
    // c is at most 1e-4 per sample².
    EXPECT_LE(static_cast<double>(chosen.size()), 2 + 2000 / std::sqrt(8 * tolerance / 1e-4));
  }
  EXPECT_TRUE(choose_keyframes({}, 1e-3).empty());
  EXPECT_EQ(choose_keyframes({1}, 1e-3), (std::vector<size_t>{0}));
  EXPECT_EQ(choose_keyframes({1, 1, 1, 1}, 0), (std::vector<size_t>{0, 3}));
}

TEST(Hjif, ComesBackWithinAThousandthOfTheFullScale) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    const std::vector<TrackSample> samples = track(10000, seed);
    const std::vector<TrackSample> read = read_hjif(write_hjif(samples));
    ASSERT_EQ(read.size(), samples.size());
    // The tolerance, half a step of 1e-5, and the float's rounding.
    EXPECT_LE(largest_error(samples, read), 4e-4 + 0.5e-5 + 1e-6);
  }
}

TEST(Hjif, AStraightLineHasThreeKeyframes) {
  // MPEG's Synthesizer makes silence of two.
  const std::vector<TrackSample> constant(1000, {0.125F, -0.25F, 0.375F, -0.5F, 0.625F, -0.75F});
  const nlohmann::json file = nlohmann::json::parse(write_hjif(constant));
  for (const nlohmann::json& channel : file["perceptions"][0]["channels"]) {
    EXPECT_EQ(channel["bands"][0]["effects"][0]["keyframes"].size(), 3u);
  }
  EXPECT_EQ(read_hjif(write_hjif(constant)), constant);
}

TEST(Hjif, WithoutToleranceEverySampleComesBack) {
  const std::vector<TrackSample> samples = track(3000);
  const std::vector<TrackSample> read = read_hjif(write_hjif(samples, 0));
  ASSERT_EQ(read.size(), samples.size());
  EXPECT_LE(largest_error(samples, read), 0.5e-5 + 1e-6);
}

TEST(Hjif, IsValidInTheFormat) {
  const nlohmann::json root = nlohmann::json::parse(write_hjif(track(100)));
  EXPECT_EQ(root["profile"], "Main");
  EXPECT_EQ(root["timescale"], 1000);
  ASSERT_EQ(root["perceptions"].size(), 1u);
  const nlohmann::json& perception = root["perceptions"][0];
  EXPECT_EQ(perception["perception_modality"], "Force");
  ASSERT_EQ(perception["channels"].size(), 6u);
  for (const nlohmann::json& channel : perception["channels"]) {
    EXPECT_EQ(channel["sample_count"], 100);
    EXPECT_EQ(channel["bands"][0]["band_type"], "Curve");
    EXPECT_EQ(channel["bands"][0]["curve_type"], "Linear");
    EXPECT_EQ(channel["bands"][0]["effects"][0]["effect_type"], "Basis");
  }
}

TEST(Hjif, ClipsAtFullScaleAndReplacesNanBySilence) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<TrackSample> read = read_hjif(write_hjif({{2, -3, nan, 0.5F, 0, 0}}));
  ASSERT_EQ(read.size(), 1u);
  EXPECT_EQ(read[0], (TrackSample{1, -1, 0, 0.5F, 0, 0}));
}

TEST(Hjif, AnEmptyTrackStaysOne) {
  EXPECT_TRUE(read_hjif(write_hjif({})).empty());
}

/// One channel of straight lines; the others are silent.
std::string hjif(const std::string& channel, const std::string& head = "") {
  const std::string silent = R"({"gain":1,"bands":[]})";
  return "{" + head + R"("perceptions":[{"perception_modality":"Vibrotactile"},)" +
         R"({"perception_modality":"Force","channels":[)" + channel + "," + silent + "," + silent +
         "," + silent + "," + silent + "," + silent + "]}]}";
}

std::string band(const std::string& keyframes, const std::string& type = "Curve",
                 const std::string& curve = "Linear", const std::string& position = "0") {
  return R"({"gain":0.5,"bands":[{"band_type":")" + type + R"(","curve_type":")" + curve +
         R"(","effects":[{"position":)" + position + R"(,"keyframes":[)" + keyframes + "]}]}]}";
}

std::string keyframe(const std::string& at, const std::string& amplitude) {
  return R"({"relative_position":)" + at + R"(,"amplitude_modulation":)" + amplitude + "}";
}

TEST(Hjif, ReadsOtherTimescalesPositionsAndGains) {
  const std::string text =
      hjif(band(keyframe("0", "0") + "," + keyframe("480", "1"), "Curve", "Linear", "96"),
           R"("timescale":48000,)");
  std::vector<std::string> others;
  const std::vector<TrackSample> read = read_hjif(text, kMaxHjifSamples, &others);
  EXPECT_EQ(others, std::vector<std::string>{"perceptions[0] (Vibrotactile)"});
  ASSERT_EQ(read.size(), 13u) << "2 ms and 10 ms more";
  for (size_t ms = 0; ms < read.size(); ++ms) {
    const double expected = ms < 2 ? 0 : 0.5 * 0.1 * static_cast<double>(ms - 2);
    EXPECT_NEAR(read[ms][0], expected, 1e-6) << ms;
    EXPECT_EQ(read[ms][1], 0);
  }
}

TEST(Hjif, SaysWhatIsWrongAndWhere) {
  const std::string good = keyframe("0", "0") + "," + keyframe("10", "1");
  const std::pair<std::string, std::string> cases[] = {
      {"", "no JSON"},
      {"[]", "not an object"},
      {"{}", "has no perceptions"},
      {R"({"perceptions":[]})", "no perception of modality Force"},
      {R"({"perceptions":[{"perception_modality":"Pressure"}]})",
       "no perception of modality Force, only perceptions[0] (Pressure)"},
      {R"({"perceptions":[{"perception_modality":"Force","channels":[]}]})", "0 channels"},
      {hjif(band(good), R"("timescale":0,)"), "timescale"},
      {hjif(band(good), R"("timescale":96000,)"), "timescale"},
      {hjif(band(good, "VectorialWave")), "VectorialWave"},
      {hjif(band(good, "Curve", "Akima")), "Akima"},
      {hjif(band(keyframe("10", "0") + "," + keyframe("10", "1"))), "not after"},
      {hjif(band(keyframe("-1", "0"))), "ticks"},
      {hjif(band(keyframe("0.5", "0"))), "ticks"},
      {hjif(band(keyframe("0", "1.5"))), "amplitude_modulation is 1.5, must be from -1 to 1"},
      {hjif(band(keyframe("0", "1e999"))), "a number that is beyond"},
      {R"({"a":)" + std::string(200'000, '[') + std::string(200'000, ']') + R"(,"b":1})",
       "more than 64 deep"},
      {hjif(band(keyframe("2147483647", "1"))), "longer than a track"},
      {hjif(R"({"bands":[]})"), "channels[0] has no gain"},
  };
  for (const auto& [text, word] : cases) {
    try {
      read_hjif(text);
      ADD_FAILURE() << "read: " << text;
    } catch (const TrackFileError& error) {
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos)
          << error.what() << " for " << text;
    }
  }
}

}  // namespace
}  // namespace spidar::test::hjif_test
