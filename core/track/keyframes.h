// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Approximates a curve by few of its points.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

namespace spidar {

/// Ascending indices of `values`, including the first and the last one, so that straight lines
/// between the values there pass all others within `tolerance`. Each line is as long as possible:
/// the slopes that pass all values so far form a cone, and the last value inside the cone ends the
/// line. Empty for no values.
inline std::vector<size_t> choose_keyframes(const std::vector<double>& values, double tolerance) {
  std::vector<size_t> chosen;
  if (values.empty()) return chosen;
  chosen.push_back(0);
  size_t begin = 0;
  while (begin + 1 < values.size()) {
    double lowest = -std::numeric_limits<double>::infinity();
    double highest = std::numeric_limits<double>::infinity();
    size_t end = begin + 1;
    for (size_t i = begin + 1; i < values.size() && lowest <= highest; ++i) {
      const double distance = static_cast<double>(i - begin);
      const double rise = values[i] - values[begin];
      const double slope = rise / distance;
      if (slope >= lowest && slope <= highest) end = i;
      lowest = std::max(lowest, (rise - tolerance) / distance);
      highest = std::min(highest, (rise + tolerance) / distance);
    }
    chosen.push_back(end);
    begin = end;
  }
  return chosen;
}

}  // namespace spidar
