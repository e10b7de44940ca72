// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <nlohmann/json.hpp>

#include "core/track/exchange_formats.h"
#include "tests/support/test.h"
#include "tests/support/written_tracks.h"

namespace spidar::test::ahap_test {
namespace {

using Json = nlohmann::json;

/// 100 s of a force that turns, with rests and steps.
std::vector<TrackSample> track() {
  std::vector<TrackSample> samples(100000);
  for (size_t i = 0; i < samples.size(); ++i) {
    const double t = 1e-3 * static_cast<double>(i);
    const double size = i % 7000 < 2000 ? 0 : 0.3 + 0.2 * std::sin(9 * t);
    samples[i] = {
        static_cast<float>(size * std::cos(t)), static_cast<float>(size * std::sin(t)), 0, 1, 0, 0};
  }
  return samples;
}

/// Time in s and intensity of all points of the curves, in their order.
std::vector<std::pair<double, double>> points_of(const Json& file) {
  std::vector<std::pair<double, double>> points;
  for (const Json& part : file["Pattern"]) {
    if (!part.contains("ParameterCurve")) continue;
    const Json& curve = part["ParameterCurve"];
    EXPECT_EQ(curve["ParameterID"], "HapticIntensityControl");
    EXPECT_LE(curve["ParameterCurveControlPoints"].size(), 16u);
    for (const Json& point : curve["ParameterCurveControlPoints"]) {
      const double time_s = curve["Time"].get<double>() + point["Time"].get<double>();
      points.emplace_back(time_s, point["ParameterValue"].get<double>());
    }
  }
  return points;
}

TEST(Ahap, TheIntensityIsTheMagnitudeOfTheForce) {
  const std::vector<TrackSample> samples = track();
  for (const double tolerance : {0.001, 0.02, 0.2}) {
    const auto points = points_of(Json::parse(write_ahap(samples, tolerance)));
    ASSERT_GT(points.size(), 2u);
    EXPECT_EQ(points.front().first, 0);
    EXPECT_NEAR(points.back().first, 99.999, 1e-9);
    size_t k = 1;
    for (size_t i = 0; i < samples.size(); ++i) {
      const double t = 1e-3 * static_cast<double>(i);
      while (k + 1 < points.size() && points[k].first < t - 1e-9) ++k;
      const auto &a = points[k - 1], &b = points[k];
      const double part = b.first > a.first ? (t - a.first) / (b.first - a.first) : 0;
      const double intensity = a.second + part * (b.second - a.second);
      const double wanted = std::hypot(samples[i][0], samples[i][1]);
      // Rounded to 1e-3 before the points are chosen.
      ASSERT_NEAR(intensity, wanted, tolerance + 0.5e-3 + 1e-6) << "at " << t << " s";
    }
  }
}

TEST(Ahap, EventsOfAtMost30sCoverTheTrack) {
  double end_s = 0;
  const Json file = Json::parse(write_ahap(track()));
  for (const Json& part : file["Pattern"]) {
    if (!part.contains("Event")) continue;
    const Json& event = part["Event"];
    EXPECT_EQ(event["EventType"], "HapticContinuous");
    EXPECT_NEAR(event["Time"].get<double>(), end_s, 1e-9);
    EXPECT_LE(event["EventDuration"].get<double>(), 30);
    end_s += event["EventDuration"].get<double>();
    for (const Json& parameter : event["EventParameters"]) {
      EXPECT_GE(parameter["ParameterValue"].get<double>(), 0);
      EXPECT_LE(parameter["ParameterValue"].get<double>(), 1);
    }
  }
  EXPECT_NEAR(end_s, 100, 1e-9);
}

TEST(Ahap, ExtremesAreClipped) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const auto points = points_of(Json::parse(write_ahap({{3, 4, 0}, {nan, 0, 0}, {0, 0, 0}})));
  ASSERT_GE(points.size(), 2u);
  for (const auto& point : points) {
    EXPECT_GE(point.second, 0);
    EXPECT_LE(point.second, 1);
  }
  EXPECT_EQ(points.front().second, 1);
  EXPECT_TRUE(Json::parse(write_ahap({}))["Pattern"].empty());
}

}  // namespace
}  // namespace spidar::test::ahap_test
