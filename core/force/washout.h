// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Lets a force that lasts fade, while its changes pass.
#pragma once

#include <cmath>

#include "core/force/motion_rendering.h"
#include "core/require.h"
#include "core/wrench.h"

namespace spidar {

/// Throws std::invalid_argument when a cut-off is out of range: finite and ≥ 0; 0: no washout.
inline void validate_washout(double cutoff_Hz) {
  require_not_negative("washout_Hz", cutoff_Hz);
}

/// The washout of motion platforms: a high-pass of first order. A wrench w that has come at once
/// is, after a time t, w exp(−2π fc t); where it ends at once, what it has lost is left in the
/// opposite direction, and fades likewise.
class Washout {
 public:
  /// `wrench` less its low-pass; no larger than `most_N` as one force (size_N()), because a force
  /// that turns round would be up to twice as large. With a cut-off of 0 it is `wrench`, to the
  /// bit. `interval_s` > 0 is that since the call before, in which that wrench stayed as it was.
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

  /// After a cut, in a picture at rest, and when something else is felt.
  void reset() { *this = Washout(); }

 private:
  Wrench before_;
  Wrench low_;
};

}  // namespace spidar
