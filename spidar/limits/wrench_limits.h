// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Limits of a wrench and its rate of change: steps of WrenchChain that neither allocate nor lock.
#pragma once

#include "core/wrench.h"
#include "spidar/limits/safety_limits.h"

namespace spidar {

/// Scales force and torque down to their limits without changing their directions. A wrench that is
/// not finite becomes zero.
Wrench limit_total(const Wrench& wanted, const SafetyLimits& limits) noexcept;

/// Returns the wrench `dt_s` after `last`, with a bounded change of force and torque per second. A
/// wrench above lowered total limits falls straight to them before it turns towards `wanted`: on a
/// curved path, its size would fall by less than each step. There is no step towards `wanted` if it
/// is not finite, or if `dt_s` is zero, negative or not a number.
Wrench limit_slew(Wrench last, const Wrench& wanted, double dt_s,
                  const SafetyLimits& limits) noexcept;

/// Ramps the wrench to zero when commands stop, and back when they begin. The ramp has zero slope
/// at both ends, so that there is neither a step nor a corner, and a command that is a little late
/// makes hardly any difference.
class StaleRamp {
 public:
  /// Returns the fraction of the wrench to apply, 0 … 1, `dt_s` after the last call. `fresh` says
  /// that there is a valid command now. A ramp_s of zero switches at once.
  double apply(bool fresh, double dt_s, const SafetyLimits& limits) noexcept;
  void reset() noexcept { way_ = 0; }
  double fraction() const noexcept { return way_ * way_ * (3 - 2 * way_); }

  /// The slope of the steepest part, relative to a straight line.
  static constexpr double kSteepest = 1.5;

 private:
  double way_ = 0;  ///< 0 … 1, linear in time
};

/// The rates of a wrench: the ramp and the slew limit.
///
/// While commands are stale, the ramp lowers the wrench even where the slew limit would not, so
/// that no slew setting, however low, maintains a force for longer than ramp_s. While the ramp
/// returns, it acts before the slew limit, so that both together do not exceed that limit. A fresh
/// command therefore changes by at most max_slew, and a stale one decreases by at most 1.5
/// max_force / ramp_s.
class WrenchLimits {
 public:
  /// Returns the wrench to apply, `dt_s` after the last call. `wanted` is within `limits`. If not
  /// `fresh`, it is ignored, and the last applied wrench ramps to exactly zero.
  Wrench apply(const Wrench& wanted, bool fresh, double dt_s, const SafetyLimits& limits) noexcept;

  /// The next apply() continues from no more than the size of `at`, which the brake has left.
  void shorten_to(const Wrench& at) noexcept;

  /// Call this when the device did not receive the result of the last apply(): the next call
  /// continues from the previous wrench.
  void undo() noexcept;
  /// The wrench from which the next apply() continues.
  const Wrench& last() const noexcept { return last_; }
  /// Whether commands are fresh, and have been for the whole ramp.
  bool is_ramped() const noexcept { return stale_.fraction() >= 1; }

  void reset() noexcept;

 private:
  Wrench last_;
  StaleRamp stale_;
  Wrench last_before_;  ///< before the last apply()
  StaleRamp stale_before_;
};

}  // namespace spidar
