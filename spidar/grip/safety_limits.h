// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What a hand may feel at most.
#pragma once

namespace spidar {

/// A limit that is negative or not a number counts as zero.
struct SafetyLimits {
  double max_force_N = 3.0;     ///< of the total force
  double max_torque_Nm = 0.1;   ///< of the total torque
  double max_slew_N_s = 300.0;  ///< full default force in 10 ms
  double max_slew_Nm_s = 10.0;
  double ramp_s = 0.04;  ///< from full to rest when commands stop, and back when they begin
};

}  // namespace spidar
