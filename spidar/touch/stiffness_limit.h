// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// How stiff a surface may be on a device whose drives lag.
#pragma once

#include <algorithm>

#include "core/touch/contact_force.h"
#include "spidar/loop/haptic_loop.h"

namespace spidar {

/// Half a tick for which a force is held, and a tick because the pose is that of the last exchange.
constexpr double kLoopDelay_s = 1.5e-9 * static_cast<double>(kTick_ns);

/// From a motion of the grip to the force that answers it: t_d of docs/touch.md.
constexpr double surface_delay_s(double drive_lag_s) noexcept {
  return kLoopDelay_s + drive_lag_s;
}

/// What a surface asks of the hand grows with stiffness · delay, and has been measured up to
/// kMostStiffness_N_m at the delay that is the default of ContactSettings.
inline double most_stiffness_N_m(double drive_lag_s) noexcept {
  const ContactSettings measured;
  return ContactSettings::kMostStiffness_N_m *
         std::min(1.0, measured.delay_s / surface_delay_s(drive_lag_s));
}

}  // namespace spidar
