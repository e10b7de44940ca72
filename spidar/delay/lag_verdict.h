// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What a measured lag means for a profile and for surfaces.
#pragma once

#include "core/api.h"
#include "core/delay/lag_fit.h"
#include "spidar/profiles/profile.h"

namespace spidar {

enum class StatedLag {
  kTooSmall,  ///< of the profile: the drive lags by more, whatever the errors of the measurement
  kRight,     ///< within the interval
  kMore,      ///< more than the drive can lag: safe, and surfaces are softer than they might be
};

struct LagVerdict {
  StatedLag stated = StatedLag::kRight;
  /// For drive_lag_s of the profile: the upper end of the interval, rounded up to 0.1 ms.
  double safe_lag_s = 0;
  double delay_s = 0;        ///< t_d with that lag
  double stiffness_N_m = 0;  ///< the largest of a surface with that delay
  double damping_N_s_m = 0;  ///< of that surface, B
  int late_ticks = 0;        ///< that are part of it, see judge_lag()
};

/// `late_ticks`: so many ticks after the next one the answer of an exchange counts while playing,
/// because the haptic loop does not wait for it any longer; they are added to the lag.
SPIDAR_API LagVerdict judge_lag(const Profile& profile, const LagFit& fit, int late_ticks);

}  // namespace spidar
