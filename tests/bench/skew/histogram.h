// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Quantiles of any number of values in little memory.
#pragma once

#include <cstdint>
#include <map>

/// Counts values in bins that are 1 % wide, so the error of a quantile is at most half of that; the
/// smallest and the largest value are exact. Values may have either sign.
class Histogram {
 public:
  void add(double value);

  uint64_t count() const { return count_; }
  double min() const { return min_; }
  double max() const { return max_; }

  /// Value below which a share `p` (0 … 1) of the values lies; NaN without values.
  double quantile(double p) const;

 private:
  std::map<int, uint64_t> bins_;  ///< by index, which increases with the value
  uint64_t count_ = 0;
  double min_ = 0;
  double max_ = 0;
};
