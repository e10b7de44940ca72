// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The steps between tensions and motors: tension slew → D/A range. None of them allocates, locks
/// or throws.
#pragma once

#include "core/grip/string_geometry.h"
#include "spidar/device.h"
#include "spidar/profiles/profile.h"

namespace spidar {

/// Bounds the change of tensions per second. At the border of the wrench-closure workspace, the
/// solution moves nearly the whole tension from some strings to others within a tick
/// (docs/workspace.md). A hand would feel that as a jerk, and a motor cannot follow it.
class TensionSlew {
 public:
  /// Shortest time in which a string passes through its whole range.
  static constexpr double kRange_s = 0.02;

  explicit TensionSlew(const Profile& profile) { reset(profile); }

  /// All strings make the same share of their step, so that no bound is exceeded and the wrench
  /// lies between the previous and the wanted one. A tension that is not a number counts as the
  /// minimum.
  StringVector apply(const StringVector& tension_N, const Profile& profile, double dt_s) noexcept;

  /// At rest: every string at its minimum.
  void reset(const Profile& profile) noexcept { last_N_ = profile.min_tension_N(); }

  /// Continues from `tension_N`, the tensions that the device has acknowledged.
  void reset(const StringVector& tension_N) noexcept { last_N_ = tension_N; }

 private:
  StringVector last_N_;
};

/// Limits tensions to the range from zero to each string's largest. A tension that is not a number
/// becomes zero.
StringVector bound_tensions(const StringVector& tension_N, const Profile& profile) noexcept;

/// Converts tensions to D/A volts with newtons_per_volt and motor_sign, clamped to the D/A range.
MotorVolts to_volts(const StringVector& tension_N, const Profile& profile) noexcept;

}  // namespace spidar
