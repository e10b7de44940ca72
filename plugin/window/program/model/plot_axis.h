// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Axes of a plot: which range they show, and the round numbers on them.
#pragma once

#include <string>
#include <vector>

namespace spidar {

/// A range of values with ticks at multiples of `step`.
struct PlotAxis {
  double low = 0, high = 1;
  double step = 1;   ///< 1, 2 or 5 times a power of ten
  int decimals = 0;  ///< that tell neighbouring ticks apart

  /// Multiples of `step` from `low` to `high`, rising.
  std::vector<double> ticks() const;
  std::string label(double value) const;
  /// 0 at `low`, 1 at `high`; values beyond are beyond.
  double share(double value) const { return (value - low) / (high - low); }
};

/// An axis over exactly this range with at most `most_steps` (≥ 1) steps. A range that is empty,
/// reversed or not finite becomes one of width 1 from `low`, or from 0.
PlotAxis make_axis(double low, double high, int most_steps);

/// Upper end of a range from 0 for these values (≥ 0), which a few outliers do not stretch: the
/// largest, but at most 1.5 times the value that 95 % of them do not exceed. Where 95 % are zero
/// there is nothing that an outlier could flatten, and it is the largest. 0 without values.
double robust_largest(std::vector<double> values);

}  // namespace spidar
