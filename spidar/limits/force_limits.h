// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <algorithm>

#include "core/wrench.h"
#include "spidar/limits/safety_limits.h"
#include "spidar/realtime/seqlock.h"

namespace spidar {

/// The limits of force and torque of a loop: those that were set, and those in effect. A raised
/// limit is in effect at once; the force approaches it at the slew limit. A lowered limit falls at
/// the slew limit to the set value, from the commanded or the delivered force, whichever is larger.
/// It also falls below the force of the strings at rest, which is a part of the delivered force
/// that no limit lowers. The same holds for the torque.
class ForceLimits {
 public:
  /// `most_N` and `most_Nm` bound the limits, however high they are set, until the first tick.
  ForceLimits(const SafetyLimits& limits, double most_N, double most_Nm) noexcept
      : most_N_(most_N),
        most_Nm_(most_Nm),
        shared_(limits),
        set_(bounded(limits)),
        now_(set_),
        before_(set_) {}

  /// Applies from the next tick on. Any thread, one caller at a time.
  void set(const SafetyLimits& limits) noexcept { shared_.store(limits); }

  // --- loop thread

  /// Begins a tick, `dt_s` after the last answered one, whose wrenches were `commanded` and
  /// `delivered`. `most_N` and `most_Nm` bound the limits from now on.
  void begin_tick(const Wrench& commanded, const Wrench& delivered, double dt_s, double most_N,
                  double most_Nm) noexcept {
    most_N_ = most_N;
    most_Nm_ = most_Nm;
    take();
    now_ = set_;
    now_.max_force_N = fallen(set_.max_force_N, before_.max_force_N,
                              std::max(commanded.force_N.norm(), delivered.force_N.norm()),
                              non_negative(set_.max_slew_N_s * dt_s));
    now_.max_torque_Nm = fallen(set_.max_torque_Nm, before_.max_torque_Nm,
                                std::max(commanded.torque_Nm.norm(), delivered.torque_Nm.norm()),
                                non_negative(set_.max_slew_Nm_s * dt_s));
  }
  /// Begins a tick in which nothing pulls.
  void begin_tick_at_rest() noexcept {
    take();
    now_ = set_;
  }
  /// Call this when the device did not receive the command of this tick.
  void undo() noexcept { now_ = before_; }

  const SafetyLimits& as_set() const noexcept { return set_; }
  const SafetyLimits& in_effect() const noexcept { return now_; }

 private:
  static double fallen(double set, double before, double exerted, double step) noexcept {
    return std::max(non_negative(set), std::min(before, exerted) - step);
  }
  SafetyLimits bounded(SafetyLimits limits) const noexcept {
    limits.max_force_N = std::min(limits.max_force_N, most_N_);
    limits.max_torque_Nm = std::min(limits.max_torque_Nm, most_Nm_);
    return limits;
  }
  /// Keeps the limits of the last tick while new ones are being written.
  void take() noexcept {
    before_ = now_;
    if (SafetyLimits limits; shared_.try_load(limits)) set_ = bounded(limits);
  }

  double most_N_, most_Nm_;
  Seqlock<SafetyLimits> shared_;
  SafetyLimits set_, now_;
  SafetyLimits before_;  ///< limits in effect before this tick
};

}  // namespace spidar
