// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The consequences of a measured lag for a profile and for surfaces.
#pragma once

#include "spidar/conformance/lag_fit.h"
#include "spidar/profiles/profile.h"

namespace spidar {

enum class StatedLag {
  kTooSmall,  ///< the drive lags by more than the profile states, beyond the error interval
  kRight,     ///< the profile's value is within the interval
  kMore,      ///< above the interval: safe, but surfaces are softer than necessary
};

struct LagVerdict {
  StatedLag stated = StatedLag::kRight;
  /// Value for drive_lag_s in the profile: the upper end of the interval, rounded up to 0.1 ms.
  double safe_lag_s = 0;
  double delay_s = 0;        ///< t_d at that lag
  double stiffness_N_m = 0;  ///< largest surface stiffness at that delay
  double damping_N_s_m = 0;  ///< damping B of that surface
  int late_ticks = 0;        ///< included in the lag, see judge_lag()
};

/// `late_ticks` is the number of additional ticks after which the loop uses the reply of an
/// exchange during playback, because it does not wait for the reply. They are added to the lag.
LagVerdict judge_lag(const Profile& profile, const LagFit& fit, int late_ticks);

}  // namespace spidar
