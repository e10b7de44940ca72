// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string>
#include <vector>

#include "core/json_text.h"
#include "core/track/exchange_formats.h"
#include "core/track/keyframes.h"

namespace spidar {
namespace {

constexpr double kLongestEvent_s = 30;
constexpr size_t kMaxPoints = 16;
/// From 0, dull, to 1, crisp. A force that changes with a picture is a push rather than a buzz.
constexpr double kSharpness = 0.2;

/// Rounds, so that files are short and 0.02 is not 0.020000000000000001.
double rounded(double value) {
  return std::round(value * 1000) / 1000;
}

double seconds(size_t sample) {
  return static_cast<double>(sample) / kTrackRate_Hz;
}

double intensity(const TrackSample& sample) {
  const double fraction = std::hypot(static_cast<double>(sample[0]), static_cast<double>(sample[1]),
                                     static_cast<double>(sample[2]));
  return std::isnan(fraction) ? 0 : rounded(std::min(fraction, 1.0));
}

std::string description(double gain) {
  std::array<char, 24> newtons;
  const auto [end, error] = std::to_chars(newtons.data(), newtons.data() + newtons.size(),
                                          kTrackForceScale_N / gain, std::chars_format::general, 3);
  return std::string("Force of a film: 1 is ").append(newtons.data(), end) + " N";
}

Json event(double time_s, double duration_s) {
  return {{"Event",
           {{"Time", rounded(time_s)},
            {"EventType", "HapticContinuous"},
            {"EventDuration", rounded(duration_s)},
            {"EventParameters",
             {{{"ParameterID", "HapticIntensity"}, {"ParameterValue", 1.0}},
              {{"ParameterID", "HapticSharpness"}, {"ParameterValue", kSharpness}}}}}}};
}

/// Writes curves of kMaxPoints each; the last point of a curve is the first of the next.
class AhapCurveWriter {
 public:
  AhapCurveWriter(const WriteText& write, bool is_first) : write_(write), is_first_(is_first) {}

  void add(size_t index, double value) {
    points_.push_back({index, value});
    if (points_.size() == kMaxPoints) write_curve();
  }
  void finish() {
    if (points_.size() > 1) write_curve();
  }

 private:
  void write_curve() {
    const double begin_s = seconds(points_.front().index);
    Json controls = Json::array();
    for (const Point& point : points_) {
      controls.push_back(
          {{"Time", rounded(seconds(point.index) - begin_s)}, {"ParameterValue", point.value}});
    }
    const Json curve = {{"ParameterCurve",
                         {{"ParameterID", "HapticIntensityControl"},
                          {"Time", begin_s},
                          {"ParameterCurveControlPoints", controls}}}};
    write_((is_first_ ? "" : ",") + curve.dump());
    is_first_ = false;
    points_.erase(points_.begin(), points_.end() - 1);
  }

  struct Point {
    size_t index;
    double value;
  };
  const WriteText& write_;
  bool is_first_;
  std::vector<Point> points_;
};

}  // namespace

void write_ahap(const SampleSource& samples, const WriteText& write, double tolerance,
                double gain) {
  write(R"({"Version":1.0,"Metadata":{"Description":)" + Json(description(gain)).dump() +
        R"(},"Pattern":[)");
  const double length_s = seconds(samples.count);
  bool is_first = true;
  for (double time_s = 0; time_s < length_s; time_s += kLongestEvent_s) {
    write((is_first ? "" : ",") +
          event(time_s, std::min(kLongestEvent_s, length_s - time_s)).dump());
    is_first = false;
  }
  AhapCurveWriter curves(write, is_first);
  KeyframeChooser points(tolerance,
                         [&curves](size_t index, double value) { curves.add(index, value); });
  samples.each([&points](const TrackSample& sample) { points.add(intensity(sample)); });
  points.finish();
  curves.finish();
  write("]}\n");
}

}  // namespace spidar
