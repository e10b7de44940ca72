// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The largest torque on a grip that a hand may release, and how that grip rotates.
#pragma once

#include <algorithm>
#include <limits>

#include "core/default_limits.h"
#include "spidar/limits/released_grip.h"

namespace spidar {

/// The largest torque limit, as released_force_N(): the whole torque rotates a free grip of the
/// smallest inertia, until the loop notices, up to kReleased_m_s of its surface. kDefaultTorque_Nm
/// is permitted as long as it rotates the grip no faster when the damper reverses it.
constexpr double released_torque_Nm(const GripBody& body, double radius_m, double drive_lag_s,
                                    double late_s = 0) noexcept {
  if (!(radius_m > 0)) return std::numeric_limits<double>::infinity();
  const double impulse_Nm_s = body.least_kg_m2 * kReleased_m_s / radius_m;
  const double noticed_s = kNoticed_s + kAnswers * late_s;
  return std::max(
      impulse_Nm_s / (noticed_s + drive_lag_s),
      std::min(kDefaultTorque_Nm, impulse_Nm_s / (noticed_s + kReversed * drive_lag_s)));
}

}  // namespace spidar
