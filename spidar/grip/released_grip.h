// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// How strong a force may be on a grip that a hand may let go of at any time.
#pragma once

#include <algorithm>

#include "spidar/profiles/profile.h"

namespace spidar {

/// Mass of a grip without a hand, from a hollow sphere to one with motors. No source states one.
constexpr double kLightestGrip_kg = 0.034;
constexpr double kHeaviestGrip_kg = 0.3;

/// The speed and the energy that a released grip may reach, see GripBrake.
constexpr double kReleased_m_s = 1.5;
constexpr double kReleased_J = 0.05;

/// Time from when a hand lets go until a command takes account of it: up to a tick until the next
/// reading, a second reading for a velocity, and a tick until the command that follows it.
constexpr double kNoticed_s = 3e-3;

/// The largest force limit. The whole force accelerates a released grip until it is noticed and, on
/// average, for the lag of the drives: to kReleased_m_s if the grip is one of kLightestGrip_kg.
/// kDefaultForce_N, which any device takes, is permitted with slow drives, too: at 3 N and 40 ms,
/// 34 g get 1.4 m/s.
constexpr double released_force_N(double drive_lag_s) noexcept {
  return std::max(kDefaultForce_N, kLightestGrip_kg * kReleased_m_s / (kNoticed_s + drive_lag_s));
}

}  // namespace spidar
