// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "spidar/text.h"

namespace spidar {

/// The axis of a plot: a range of values with ticks at multiples of `step`.
struct PlotAxis {
  /// A tolerance in steps, so that rounding low / step neither adds nor loses a tick at the end.
  static constexpr double kRounding = 1e-9;

  double low = 0, high = 1;
  double step = 1;   ///< 1, 2 or 5 times a power of ten
  int decimals = 0;  ///< enough to distinguish neighbouring ticks

  std::vector<double> ticks() const {
    std::vector<double> values;
    const double first = std::ceil(low / step - kRounding),
                 last = std::floor(high / step + kRounding);
    for (double n = first; n <= last; ++n) values.push_back(n * step);
    return values;
  }
  std::string label(double value) const {
    return formatted("%.*f", decimals, value == 0 ? 0.0 : value);  // avoids "-0"
  }
  /// 0 at `low`, 1 at `high`; smaller and larger values map beyond.
  double fraction(double value) const { return (value - low) / (high - low); }
};

/// The smallest of 1, 2, 5 times a power of ten that is not below `least` (> 0).
inline double round_step(double least) {
  const double power = std::pow(10, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= least * (1 - PlotAxis::kRounding)) return factor * power;
  }
  return 10 * power;
}

/// The smallest of 1, 2, 3, 4, 5, 6, 8 times a power of ten that is not below `least` (> 0): the
/// end of an axis that grows in small steps.
inline double round_top(double least) {
  const double power = std::pow(10, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0}) {
    if (factor * power >= least * (1 - PlotAxis::kRounding)) return factor * power;
  }
  return 10 * power;
}

/// An axis over exactly this range with at most `most_steps` (≥ 1) steps. A range that is empty,
/// reversed or not finite becomes one of width 1 from `low`, or from 0.
inline PlotAxis make_axis(double low, double high, int most_steps) {
  PlotAxis axis;
  axis.low = std::isfinite(low) ? low : 0;
  axis.high = std::isfinite(high) && high > axis.low ? high : axis.low + 1;
  axis.step = round_step((axis.high - axis.low) / std::max(most_steps, 1));
  axis.decimals =
      std::clamp(static_cast<int>(-std::floor(std::log10(axis.step) + PlotAxis::kRounding)), 0, 9);
  return axis;
}

/// Upper end of an axis of forces up to `largest_N`: one of few round numbers, so that it changes
/// seldom, and at least kMin_N, where a hand hardly feels anything.
inline double force_axis_end_N(double largest_N) {
  constexpr double kMin_N = 0.1, kHeadroom = 1.1, kSteps = 4;
  const double end_N = std::max(kHeadroom * largest_N, kMin_N);
  const double step_N = round_step(end_N / kSteps);
  return step_N * std::ceil(end_N / step_N * (1 - PlotAxis::kRounding));
}

/// The upper end of an axis from 0 for these values (≥ 0), which a few outliers do not stretch: the
/// largest value, but at most 1.5 times the value that 95 % of them do not exceed. If 95 % are
/// zero, an outlier cannot flatten anything, and the end is the largest value. 0 without values.
inline double robust_largest(std::vector<double> values) {
  constexpr double kUsual = 0.95, kHeadroom = 1.5;
  if (values.empty()) return 0;
  const double largest = *std::max_element(values.begin(), values.end());
  const auto at =
      values.begin() +
      static_cast<std::ptrdiff_t>(std::ceil(kUsual * static_cast<double>(values.size()))) - 1;
  std::nth_element(values.begin(), at, values.end());
  return *at > 0 ? std::min(largest, kHeadroom * *at) : largest;
}

}  // namespace spidar
