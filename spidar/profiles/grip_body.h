// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <algorithm>

namespace spidar {

/// Range of the mass of a grip alone, from a hollow sphere to one with motors. No source states it.
constexpr double kLightestGrip_kg = 0.034;
constexpr double kHeaviestGrip_kg = 0.3;

/// Mass and moment of inertia of a grip that nobody holds.
struct GripBody {
  double least_kg_m2 = 0;  ///< the smallest moment of inertia
  double most_kg_m2 = 0;   ///< the largest
  double surface_m = 0;    ///< largest distance of its mass from the centre

  /// Radius of a ball that a hand encloses. A sphere of 34 g is larger only if it is lighter than
  /// 250 kg/m³, which no print is.
  static constexpr double kBall_m = 0.032;

  /// The body of a grip whose strings end at `radius_m` and whose moment of inertia nobody states:
  /// from a solid sphere of the lightest grip's mass to the heaviest grip's mass at the surface.
  static constexpr GripBody inferred(double radius_m) noexcept {
    const double solid_m = std::min(radius_m, kBall_m), surface_m = std::max(radius_m, kBall_m);
    return {0.4 * kLightestGrip_kg * solid_m * solid_m, kHeaviestGrip_kg * surface_m * surface_m,
            surface_m};
  }
};

}  // namespace spidar
