// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The steps between a wanted wrench and the motors. Order: finite → limit → slew → stale →
/// (tension command) → tension slew → D/A range. Each step is a small object that can be tested
/// alone. None of them allocates, locks or throws.
#pragma once

#include <cstdint>

#include "core/grip/string_geometry.h"
#include "core/wrench.h"
#include "spidar/device.h"
#include "spidar/profiles/profile.h"

namespace spidar {

/// A limit that is negative or not a number counts as zero.
struct SafetyLimits {
  double max_force_N = 3.0;     ///< of the total force
  double max_torque_Nm = 0.1;   ///< of the total torque
  double max_slew_N_s = 300.0;  ///< full default force in 10 ms
  double max_slew_Nm_s = 10.0;
  double ramp_s = 0.04;  ///< from full to rest when commands stop, and back when they begin
};

/// Replaces a wrench that is not finite in any component by zero, and counts it.
class FiniteCheck {
 public:
  Wrench apply(const Wrench& wanted) noexcept;
  uint64_t rejected() const noexcept { return rejected_; }

 private:
  uint64_t rejected_ = 0;
};

/// Scales force and torque down to their limits without changing their directions. A wrench that is
/// not finite becomes zero.
Wrench limit_total(const Wrench& wanted, const SafetyLimits& limits) noexcept;

/// Bounds the change of force and torque per second. The result never exceeds the total limits if
/// `wanted` does not, so lowered limits take effect at once.
class SlewLimit {
 public:
  /// Returns the next wrench, `dt_s` after the last one. There is no step towards `wanted` if it is
  /// not finite, or if `dt_s` is zero, negative or not a number.
  Wrench apply(const Wrench& wanted, double dt_s, const SafetyLimits& limits) noexcept;

  /// Continues from `at`.
  void reset(const Wrench& at = {}) noexcept { last_ = at; }
  const Wrench& last() const noexcept { return last_; }

 private:
  Wrench last_;
};

/// Ramps the wrench to rest when commands stop, and back when they begin. The ramp is level at both
/// ends, so that there is neither a step nor a corner, and a command that is a little late makes
/// hardly any difference.
class StaleRamp {
 public:
  /// Returns the share of the wrench to apply, 0 … 1, `dt_s` after the last call. `fresh`: there is
  /// a valid command now. A ramp_s of zero switches at once.
  double apply(bool fresh, double dt_s, const SafetyLimits& limits) noexcept;
  void reset() noexcept { way_ = 0; }
  double share() const noexcept { return way_ * way_ * (3 - 2 * way_); }

  /// Slope of the steepest part, relative to a straight line.
  static constexpr double kSteepest = 1.5;

 private:
  double way_ = 0;  // 0 … 1, in ramp_s
};

/// The four steps in a row, from a wanted wrench to the commanded one.
///
/// On the way to rest, the stale share is the last step, so that no slew setting, however low,
/// maintains a force for longer than ramp_s. On the way back, it comes before the slew limit, so
/// that both together do not exceed that limit. A fresh command therefore changes by at most
/// max_slew, and a stale one decreases by at most 1.5 max_force / ramp_s.
class WrenchSafety {
 public:
  /// Returns the wrench to apply, `dt_s` after the last call. If not `fresh`, `wanted` is ignored,
  /// and the wrench applied last ramps to exactly zero.
  Wrench apply(const Wrench& wanted, bool fresh, double dt_s, const SafetyLimits& limits) noexcept;

  /// The device did not receive the result of the last apply(): the next call continues from the
  /// wrench before it.
  void undo() noexcept;
  /// The wrench from which the next apply() continues.
  const Wrench& last() const noexcept { return slew_.last(); }

  /// Sets the state to rest, as after construction. The count of rejected wrenches is kept.
  void reset() noexcept;

  uint64_t rejected() const noexcept { return finite_.rejected(); }

 private:
  FiniteCheck finite_;
  SlewLimit slew_;
  StaleRamp stale_;
  SlewLimit slew_before_;  // the last apply()
  StaleRamp stale_before_;
};

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
