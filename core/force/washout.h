// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cmath>

#include "core/require.h"
#include "core/wrench_size.h"

namespace spidar {

/// Throws std::invalid_argument unless the cut-off is finite and ≥ 0; 0: no washout.
inline void validate_washout(double cutoff_Hz) {
  require_not_negative("washout_Hz", cutoff_Hz);
}

/// Lets a lasting force fade, while its changes pass: the washout of motion platforms, a high-pass
/// of first order. A wrench w that begins suddenly is w exp(−2π fc t) after a time t; when it ends
/// suddenly, the lost part appears in the opposite direction, and fades likewise.
class Washout {
 public:
  /// Returns `wrench` minus its low-pass, limited to `most_N` as one force (size_N()), because a
  /// force that reverses would be up to twice as large. With a cut-off of 0 the result is exactly
  /// `wrench`. `interval_s` > 0 is the time since the previous call.
  Wrench apply(const Wrench& wrench, double interval_s, double cutoff_Hz, double most_N) {
    if (cutoff_Hz == 0) {
      reset();
      return wrench;
    }
    low_ = interpolate(before_, low_, std::exp(-2 * M_PI * cutoff_Hz * interval_s));
    before_ = wrench;
    const Wrench passed = wrench - low_;
    const double size = size_N(passed);
    return size > most_N ? (most_N / size) * passed : passed;
  }

  /// Call this after a cut, in a still picture, and when something else is felt.
  void reset() { *this = Washout(); }

 private:
  Wrench before_;
  Wrench low_;
};

}  // namespace spidar
