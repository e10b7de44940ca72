// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The steps between a wanted wrench and the motors. Order: finite → limit → slew → stale →
/// (tension command) → tension slew → D/A range. Each is a small object that can be tested alone;
/// none of them allocates, locks or throws.
#pragma once

#include <cstdint>

#include "core/api.h"
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
  double ramp_s = 0.04;  ///< from full to rest and back when commands stop or begin
};

/// Not finite in any part: zero instead, and counted.
class SPIDAR_API FiniteCheck {
 public:
  Wrench apply(const Wrench& wanted) noexcept;
  uint64_t rejected() const noexcept { return rejected_; }

 private:
  uint64_t rejected_ = 0;
};

/// Shortens force and torque to their limits, keeping their directions. Not finite: zero.
SPIDAR_API Wrench limit_total(const Wrench& wanted, const SafetyLimits& limits) noexcept;

/// Bounds the change of force and torque per second. What it returns is also never above the total
/// limits when `wanted` is not: lowered limits hold at once.
class SPIDAR_API SlewLimit {
 public:
  /// Next wrench, `dt_s` after the last. No time passed (or a dt that is negative or not a number),
  /// or a `wanted` that is not finite: no step towards it.
  Wrench apply(const Wrench& wanted, double dt_s, const SafetyLimits& limits) noexcept;

  /// Continues from `at`.
  void reset(const Wrench& at = {}) noexcept { last_ = at; }
  const Wrench& last() const noexcept { return last_; }

 private:
  Wrench last_;
};

/// Takes the wrench to rest when commands stop, and back in when they begin: level at both ends, so
/// that neither is a step nor a corner, and a command that is a little late is hardly missed.
class SPIDAR_API StaleRamp {
 public:
  /// Share of the wrench to apply after `dt_s` more, 0 … 1. `fresh`: there is a valid command now.
  /// A ramp_s of zero switches at once.
  double apply(bool fresh, double dt_s, const SafetyLimits& limits) noexcept;
  void reset() noexcept { way_ = 0; }
  double share() const noexcept { return way_ * way_ * (3 - 2 * way_); }

  /// The steepest part is so much steeper than a straight line.
  static constexpr double kSteepest = 1.5;

 private:
  double way_ = 0;  // 0 … 1, in ramp_s
};

/// The four steps in a row, from a wanted wrench to the commanded one.
///
/// On the way to rest the stale share is the last step, so that no slew setting, however low, keeps
/// a force alive for longer than ramp_s. On the way in it comes before the slew limit, so that both
/// together do not exceed that limit. A fresh command therefore changes by at most max_slew, a
/// stale one falls by at most 1.5 max_force / ramp_s.
class SPIDAR_API WrenchSafety {
 public:
  /// Wrench to apply `dt_s` after the last call. Not `fresh`: `wanted` is ignored, and the wrench
  /// applied last is ramped to rest, after which nothing of it is left.
  Wrench apply(const Wrench& wanted, bool fresh, double dt_s, const SafetyLimits& limits) noexcept;

  /// The device did not get what the last apply() returned: the next one continues from the wrench
  /// before it.
  void undo() noexcept;
  /// Wrench that the next apply() continues from.
  const Wrench& last() const noexcept { return slew_.last(); }

  /// At rest, as after construction; what was rejected stays counted.
  void reset() noexcept;

  uint64_t rejected() const noexcept { return finite_.rejected(); }

 private:
  FiniteCheck finite_;
  SlewLimit slew_;
  StaleRamp stale_;
  SlewLimit slew_before_;  // the last apply()
  StaleRamp stale_before_;
};

/// Bounds the change of tensions per second. At the border of the poses that strings can balance
/// the solution moves nearly the whole tension from some strings to others within a tick
/// (docs/workspace.md), which a hand would feel as a jerk and a motor cannot follow.
class SPIDAR_API TensionSlew {
 public:
  /// A string takes this long at least through its whole range.
  static constexpr double kRange_s = 0.02;

  explicit TensionSlew(const Profile& profile) { reset(profile); }

  /// All strings go the same share of the way, so that no bound is passed, and the wrench lies
  /// between the one of before and the wanted one. Not a number counts as the minimum.
  StringVector apply(const StringVector& tension_N, const Profile& profile, double dt_s) noexcept;

  /// At rest: every string at its minimum.
  void reset(const Profile& profile) noexcept { last_N_ = profile.min_tension_N(); }

  /// Continues from `tension_N`: what the device has acknowledged.
  void reset(const StringVector& tension_N) noexcept { last_N_ = tension_N; }

 private:
  StringVector last_N_;
};

/// Tensions from zero to each string's largest. Not a number counts as zero.
SPIDAR_API StringVector bound_tensions(const StringVector& tension_N,
                                       const Profile& profile) noexcept;

/// Tension to D/A volts by newtons_per_volt and motor_sign, clamped to the D/A range.
SPIDAR_API MotorVolts to_volts(const StringVector& tension_N, const Profile& profile) noexcept;

}  // namespace spidar
