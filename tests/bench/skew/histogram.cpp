// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/bench/skew/histogram.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace {

constexpr double kSmallest = 1e-9;  // values nearer to zero count as zero
constexpr double kRatio = 1.01;

int index_of(double value) {
  const double size = std::abs(value);
  if (size < kSmallest) return 0;
  const int index = 1 + static_cast<int>(std::log(size / kSmallest) / std::log(kRatio));
  return value < 0 ? -index : index;
}

double centre_of(int index) {
  if (index == 0) return 0;
  const double size = kSmallest * std::pow(kRatio, std::abs(index) - 0.5);
  return index < 0 ? -size : size;
}

}  // namespace

void Histogram::add(double value) {
  if (!std::isfinite(value)) return;
  min_ = count_ == 0 ? value : std::min(min_, value);
  max_ = count_ == 0 ? value : std::max(max_, value);
  ++count_;
  ++bins_[index_of(value)];
}

double Histogram::quantile(double p) const {
  if (count_ == 0) return std::numeric_limits<double>::quiet_NaN();
  const double wanted = p * static_cast<double>(count_);
  double below = 0;
  for (const auto& [index, in_bin] : bins_) {
    below += static_cast<double>(in_bin);
    if (below >= wanted) return std::clamp(centre_of(index), min_, max_);
  }
  return max_;
}
