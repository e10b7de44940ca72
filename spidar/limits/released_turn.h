// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// How strong a torque may be on a grip that a hand may let go of, and how that grip turns.
#pragma once

#include <algorithm>
#include <limits>

#include "core/default_limits.h"
#include "spidar/limits/released_grip.h"

namespace spidar {

/// Radius of a ball that a hand encloses. A sphere of 34 g is larger only if it is lighter than 250
/// kg/m³, which no print is.
constexpr double kBall_m = 0.032;

/// How far from the centre the mass of a grip may be whose strings end at `radius_m`.
constexpr double surface_m(double radius_m) noexcept {
  return std::max(radius_m, kBall_m);
}

/// The smallest moment of inertia of a grip, as no source states one: that of a solid sphere of the
/// lightest grip's mass.
constexpr double least_inertia_kg_m2(double radius_m) noexcept {
  const double solid_m = std::min(radius_m, kBall_m);
  return 0.4 * kLightestGrip_kg * solid_m * solid_m;
}

/// The largest: the mass of the heaviest grip at its surface, two and a half times a solid
/// sphere's.
constexpr double most_inertia_kg_m2(double radius_m) noexcept {
  return kHeaviestGrip_kg * surface_m(radius_m) * surface_m(radius_m);
}

/// The largest torque limit, as released_force_N(): the whole torque turns a free grip of the
/// smallest inertia, until it is noticed, up to kReleased_m_s of its surface. kDefaultTorque_Nm is
/// permitted as long as it turns it no faster when the damper reverses it.
constexpr double released_torque_Nm(double radius_m, double drive_lag_s,
                                    double late_s = 0) noexcept {
  if (!(radius_m > 0)) return std::numeric_limits<double>::infinity();
  const double impulse_Nm_s = least_inertia_kg_m2(radius_m) * kReleased_m_s / radius_m;
  const double noticed_s = kNoticed_s + kAnswers * late_s;
  return std::max(
      impulse_Nm_s / (noticed_s + drive_lag_s),
      std::min(kDefaultTorque_Nm, impulse_Nm_s / (noticed_s + kReversed * drive_lag_s)));
}

}  // namespace spidar
