// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include "core/default_limits.h"

namespace spidar {

/// Replaces negative values and NaN by zero.
constexpr double non_negative(double x) noexcept {
  return x > 0 ? x : 0;
}

/// The limits of the wrench on a hand. A limit that is negative or not a number counts as zero.
struct SafetyLimits {
  double max_force_N = kDefaultForce_N;      ///< of the total force
  double max_torque_Nm = kDefaultTorque_Nm;  ///< of the total torque
  double max_slew_N_s = 300.0;               ///< full default force in 10 ms
  double max_slew_Nm_s = 10.0;
  double ramp_s = 0.04;  ///< from full to zero when commands stop, and back when they begin
};

}  // namespace spidar
