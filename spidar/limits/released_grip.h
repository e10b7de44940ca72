// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The largest force on a grip that a hand may release at any time.
#pragma once

#include <algorithm>

#include "core/default_limits.h"
#include "spidar/profiles/grip_body.h"

namespace spidar {

/// The speed and the energy that a released grip may reach, see GripBrake.
constexpr double kReleased_m_s = 1.5;
constexpr double kReleased_J = 0.05;

/// The time from the release until a command takes account of it: up to a tick until the next
/// reading, a second reading for a velocity, and a tick until the command that follows.
constexpr int kAnswers = 3;
constexpr double kNoticed_s = kAnswers * 1e-3;

/// The fraction of the drives' lag τ for which a force continues to accelerate when the brake
/// reverses it: after τ ln 2 the force is zero, and until then 1 − ln 2 of F τ has acted.
constexpr double kReversed = 0.307;

/// The largest force limit, which accelerates a grip of kLightestGrip_kg to kReleased_m_s. The
/// whole force acts until the loop notices the release, with answers that take `late_s` longer than
/// a tick, and then, on average, for the lag of the drives. kDefaultForce_N is permitted as long as
/// it throws the grip no faster when the damper reverses it: with a lag of up to 45 ms.
constexpr double released_force_N(double drive_lag_s, double late_s = 0) noexcept {
  const double impulse_N_s = kLightestGrip_kg * kReleased_m_s;
  const double noticed_s = kNoticed_s + kAnswers * late_s;
  return std::max(impulse_N_s / (noticed_s + drive_lag_s),
                  std::min(kDefaultForce_N, impulse_N_s / (noticed_s + kReversed * drive_lag_s)));
}

}  // namespace spidar
