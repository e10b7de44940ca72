// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/tracking/light_change.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace spidar {
namespace {

/// Statistics of two pictures of the same size, in grey levels.
struct Statistics {
  double mean_before = 0;
  double mean_now = 0;
  double variance_before = 0;
  double variance_now = 0;
  double covariance = 0;

  double gain() const { return std::sqrt(variance_now / variance_before); }
  /// Below a variance of 1 only rounding errors would be compared.
  bool has_contrast() const { return variance_before >= 1 && variance_now >= 1; }
};

Statistics compare(const PaddedImage& before, const PaddedImage& now) {
  int64_t a = 0;
  int64_t b = 0;
  int64_t aa = 0;
  int64_t bb = 0;
  int64_t ab = 0;
  for (int y = 0; y < now.height(); ++y) {
    const uint8_t* p = before.row(y);
    const uint8_t* q = now.row(y);
    for (int x = 0; x < now.width(); ++x) {
      a += p[x];
      b += q[x];
      aa += p[x] * p[x];
      bb += q[x] * q[x];
      ab += p[x] * q[x];
    }
  }
  const auto n = static_cast<double>(now.width()) * now.height();
  Statistics s;
  s.mean_before = static_cast<double>(a) / n;
  s.mean_now = static_cast<double>(b) / n;
  s.variance_before = static_cast<double>(aa) / n - s.mean_before * s.mean_before;
  s.variance_now = static_cast<double>(bb) / n - s.mean_now * s.mean_now;
  s.covariance = static_cast<double>(ab) / n - s.mean_before * s.mean_now;
  return s;
}

}  // namespace

float contrast_gain(const GrayPyramid& before, const GrayPyramid& now) {
  constexpr double kNoticed = 0.1;
  const Statistics s = compare(before.levels.back(), now.levels.back());
  if (!s.has_contrast() || std::abs(s.gain() - 1) < kNoticed) return 1;
  return static_cast<float>(s.gain());
}

bool only_light_changed(const GrayPyramid& before, const GrayPyramid& now) {
  constexpr double kNoticed = 0.01;
  constexpr double kNoticed_grey = 0.5;
  const Statistics coarse = compare(before.levels.back(), now.levels.back());
  if (!coarse.has_contrast() || (std::abs(coarse.gain() - 1) < kNoticed &&
                                 std::abs(coarse.mean_now - coarse.mean_before) < kNoticed_grey)) {
    return false;
  }
  const Statistics s = compare(before.levels[1], now.levels[1]);
  if (!s.has_contrast()) return false;
  const double slope = s.covariance / s.variance_before;
  const double left = s.variance_now - slope * s.covariance;
  // Each picture is rounded at most three times: in the frame, by reduction, and by halving.
  constexpr double kRounding = 3.0 / 12;
  return left <= kRounding * (1 + slope * slope);
}

}  // namespace spidar
