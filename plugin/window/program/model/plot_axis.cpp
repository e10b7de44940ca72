// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/window/program/model/plot_axis.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace spidar {
namespace {

constexpr double kUsual = 0.95, kHeadroom = 1.5;
/// Of a step: rounding of low / step must neither add nor lose a tick at the end of the range.
constexpr double kRounding = 1e-9;

/// The smallest of 1, 2, 5 times a power of ten that is not below `least` (> 0).
double round_step(double least) {
  const double power = std::pow(10, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= least * (1 - kRounding)) return factor * power;
  }
  return 10 * power;
}

}  // namespace

std::vector<double> PlotAxis::ticks() const {
  std::vector<double> values;
  const double first = std::ceil(low / step - kRounding),
               last = std::floor(high / step + kRounding);
  for (double n = first; n <= last; ++n) values.push_back(n * step);
  return values;
}

std::string PlotAxis::label(double value) const {
  char text[32];
  std::snprintf(text, sizeof text, "%.*f", decimals, value == 0 ? 0.0 : value);  // no "-0"
  return text;
}

PlotAxis make_axis(double low, double high, int most_steps) {
  PlotAxis axis;
  axis.low = std::isfinite(low) ? low : 0;
  axis.high = std::isfinite(high) && high > axis.low ? high : axis.low + 1;
  axis.step = round_step((axis.high - axis.low) / std::max(most_steps, 1));
  axis.decimals =
      std::clamp(static_cast<int>(-std::floor(std::log10(axis.step) + kRounding)), 0, 9);
  return axis;
}

double robust_largest(std::vector<double> values) {
  if (values.empty()) return 0;
  const double largest = *std::max_element(values.begin(), values.end());
  const auto at =
      values.begin() +
      static_cast<std::ptrdiff_t>(std::ceil(kUsual * static_cast<double>(values.size()))) - 1;
  std::nth_element(values.begin(), at, values.end());
  return *at > 0 ? std::min(largest, kHeadroom * *at) : largest;
}

}  // namespace spidar
