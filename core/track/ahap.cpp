// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "core/track/exchange_formats.h"
#include "core/track/keyframes.h"

namespace spidar {
namespace {

using OrderedJson = nlohmann::ordered_json;

constexpr double kLongestEvent_s = 30;
constexpr size_t kMostPoints = 16;
/// From 0, dull, to 1, crisp. A force that changes with a picture is nearer to a push than to a
/// buzz.
constexpr double kSharpness = 0.2;

/// Rounded, so that files are short and 0.02 is not 0.020000000000000001.
double rounded(double value) {
  return std::round(value * 1000) / 1000;
}

double seconds(size_t sample) {
  return static_cast<double>(sample) / kTrackRate_Hz;
}

double intensity(const TrackSample& sample) {
  const double share = std::hypot(static_cast<double>(sample[0]), static_cast<double>(sample[1]),
                                  static_cast<double>(sample[2]));
  return std::isfinite(share) ? rounded(std::min(share, 1.0)) : 0;
}

std::string description(double gain) {
  char text[64];
  std::snprintf(text, sizeof text, "Force of a film: 1 is %.3g N", kTrackForceScale_N / gain);
  return text;
}

OrderedJson event(double time_s, double duration_s) {
  return {{"Event",
           {{"Time", rounded(time_s)},
            {"EventType", "HapticContinuous"},
            {"EventDuration", rounded(duration_s)},
            {"EventParameters",
             {{{"ParameterID", "HapticIntensity"}, {"ParameterValue", 1.0}},
              {{"ParameterID", "HapticSharpness"}, {"ParameterValue", kSharpness}}}}}}};
}

/// From points[begin] to points[end].
OrderedJson curve(const std::vector<double>& values, const std::vector<size_t>& points,
                  size_t begin, size_t end) {
  const double begin_s = seconds(points[begin]);
  OrderedJson controls = OrderedJson::array();
  for (size_t k = begin; k <= end; ++k) {
    controls.push_back(
        {{"Time", rounded(seconds(points[k]) - begin_s)}, {"ParameterValue", values[points[k]]}});
  }
  return {{"ParameterCurve",
           {{"ParameterID", "HapticIntensityControl"},
            {"Time", begin_s},
            {"ParameterCurveControlPoints", controls}}}};
}

}  // namespace

std::string write_ahap(const std::vector<TrackSample>& samples, double tolerance, double gain) {
  std::vector<double> values;
  values.reserve(samples.size());
  for (const TrackSample& sample : samples) values.push_back(intensity(sample));
  OrderedJson pattern = OrderedJson::array();
  const double length_s = seconds(samples.size());
  for (double time_s = 0; time_s < length_s; time_s += kLongestEvent_s) {
    pattern.push_back(event(time_s, std::min(kLongestEvent_s, length_s - time_s)));
  }
  const std::vector<size_t> points = choose_keyframes(values, tolerance);
  for (size_t begin = 0; begin + 1 < points.size(); begin += kMostPoints - 1) {
    const size_t end = std::min(begin + kMostPoints - 1, points.size() - 1);
    pattern.push_back(curve(values, points, begin, end));
  }
  return OrderedJson{{"Version", 1.0},
                     {"Metadata", {{"Description", description(gain)}}},
                     {"Pattern", pattern}}
             .dump() +
         "\n";
}

}  // namespace spidar
