// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The last steps of a wrench before the grip, after the vibration budget and the brake: finite →
/// limit → slew → stale. None of them allocates, locks or throws.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>

#include <Eigen/Core>

#include "core/wrench.h"
#include "spidar/grip/grip.h"

namespace spidar {

/// Scales force and torque down to their limits without changing their directions. A wrench that is
/// not finite becomes zero.
Wrench limit_total(const Wrench& wanted, const SafetyLimits& limits) noexcept;

/// Returns the wrench `dt_s` after `last`, with a bounded change of force and torque per second. A
/// wrench above the total limits, because they were lowered, comes straight down to them before it
/// turns towards `wanted`: on a way aside, it would fall by less than each step. There is no step
/// towards `wanted` if it is not finite, or if `dt_s` is zero, negative or not a number.
Wrench limit_slew(Wrench last, const Wrench& wanted, double dt_s,
                  const SafetyLimits& limits) noexcept;

/// Ramps the wrench to rest when commands stop, and back when they begin. The ramp is level at both
/// ends, so that there is neither a step nor a corner, and a command that is a little late makes
/// hardly any difference.
class StaleRamp {
 public:
  /// Returns the fraction of the wrench to apply, 0 … 1, `dt_s` after the last call. `fresh`: there
  /// is a valid command now. A ramp_s of zero switches at once.
  double apply(bool fresh, double dt_s, const SafetyLimits& limits) noexcept;
  void reset() noexcept { way_ = 0; }
  double fraction() const noexcept { return way_ * way_ * (3 - 2 * way_); }

  /// Slope of the steepest part, relative to a straight line.
  static constexpr double kSteepest = 1.5;

 private:
  double way_ = 0;  ///< 0 … 1, in ramp_s
};

/// The four steps in a row, from a wanted wrench to the commanded one.
///
/// On the way to rest, the stale fraction is the last step, so that no slew setting, however low,
/// maintains a force for longer than ramp_s. On the way back, it comes before the slew limit, so
/// that both together do not exceed that limit. A fresh command therefore changes by at most
/// max_slew, and a stale one decreases by at most 1.5 max_force / ramp_s.
class WrenchLimits {
 public:
  /// Returns the wrench to apply, `dt_s` after the last call. If not `fresh`, `wanted` is ignored,
  /// and the wrench applied last ramps to exactly zero.
  Wrench apply(const Wrench& wanted, bool fresh, double dt_s, const SafetyLimits& limits) noexcept;

  /// The next apply() continues from `at`, to which the brake has reduced the last result.
  void continue_from(const Wrench& at) noexcept { last_ = at; }

  /// The device did not receive the result of the last apply(): the next call continues from the
  /// wrench before it.
  void undo() noexcept;
  /// The wrench from which the next apply() continues.
  const Wrench& last() const noexcept { return last_; }
  /// Whether commands are fresh, and have been for the whole ramp.
  bool is_ramped() const noexcept { return stale_.fraction() >= 1; }

  /// Sets the state to rest, as after construction. The count of rejected wrenches is kept.
  void reset() noexcept;

  /// How many wanted wrenches were not finite. Each counted as zero.
  uint64_t rejected() const noexcept { return rejected_; }

 private:
  uint64_t rejected_ = 0;
  Wrench last_;
  StaleRamp stale_;
  Wrench last_before_;  ///< the last apply()
  StaleRamp stale_before_;
};

/// Measures the vibration that the strings cause and finds the fraction of the force that may go
/// on.
///
/// The alternating part of the force, divided by kMoved_kg, is an acceleration. It is weighted with
/// W_h of ISO 5349-1, squared and integrated. A torque counts as the force at the grip's radius
/// that causes it. The weight is 0.03 at 1 Hz, 0.25 at 3 Hz, most at 12 Hz, and falls as 1/f above
/// that, so that a slow force hardly counts.
///
/// There is a store of kStore_m2_s3, from which the vibration takes, and which is refilled with
/// kRefill_m2_s4. In any 24 hours a hand therefore gets at most kStore_m2_s3 + 24 h ·
/// kRefill_m2_s4, which is the daily action value of Directive 2002/44/EC: 2.5 m/s² for eight
/// hours. The fraction falls so that the vibration takes at most 1/kEmptied_s of what is left each
/// second, and is 1 as long as this is no restriction.
class VibrationBudget {
 public:
  struct State {
    /// Fraction of the wanted wrench, within its limits, that may be exerted, 0 … 1.
    double fraction = 1;
    /// Fraction of the store that is left, 0 … 1.
    double left = 1;

    /// A hand notices that the force is lowered: a force must change by 7 % for that.
    bool lowered() const noexcept { return fraction < 0.93; }
  };

  static constexpr double kActionValue_m_s2 = 2.5;
  static constexpr double kDay_m2_s3 = kActionValue_m_s2 * kActionValue_m_s2 * 8 * 3600;
  static constexpr double kStore_m2_s3 = kDay_m2_s3 / 2;
  static constexpr double kRefill_m2_s4 = (kDay_m2_s3 - kStore_m2_s3) / (24 * 3600);
  static constexpr double kEmptied_s = 60;
  /// Vibration that is always permitted, a quarter of the refill: 0.51 m/s².
  static constexpr double kAlways_m2_s4 = kRefill_m2_s4 / 4;
  /// A lowered force returns with this time constant.
  static constexpr double kReturn_s = 20;
  /// Mass that the force moves. It is that of a grip alone, which is conservative. ISO 10068 has
  /// values of the hand, but for handles that are gripped with 25 N or more.
  static constexpr double kMoved_kg = 0.1;
  /// Period of the weighting filter, s.
  static constexpr double kTick_s = 1e-3;

  /// `grip_radius_m` converts torques to forces; 0: torques do not count.
  explicit VibrationBudget(double grip_radius_m) noexcept;

  /// The strings exert `strings` in a tick, `passed_s` after the last one. The filters run in steps
  /// of kTick_s, however irregular the ticks are. `now_ns` rises.
  void update(const Wrench& strings, double passed_s, int64_t now_ns) noexcept;

  double fraction() const noexcept { return state_.fraction; }
  /// The state after the last update().
  const State& state() const noexcept { return state_; }

  /// When the store will be full again if there is no more vibration, on the clock of update().
  int64_t full_at_ns() const noexcept {
    return std::max(full_at_ns_, restored_ns_.load(std::memory_order_relaxed));
  }
  /// From the next update() on, the store will not be full before this time. Any thread.
  void restore(int64_t full_at_ns) noexcept {
    restored_ns_.store(full_at_ns, std::memory_order_relaxed);
  }
  /// What all vibration so far has taken, as the time that refilling it takes. Any thread.
  int64_t taken_ns() const noexcept { return taken_ns_.load(std::memory_order_relaxed); }

 private:
  using Six = Eigen::Array<double, 6, 1>;

  /// Second-order section at kTick_s, transposed direct form II.
  struct Section {
    /// (n2 s² + n1 s + n0) / (s² + ω/Q s + ω²) by the bilinear transform.
    Section(double n2, double n1, double n0, double omega_rad_s, double q) noexcept;
    Six process(const Six& in) noexcept;

    double b0, b1, b2, a1, a2;
    Six s1 = Six::Zero(), s2 = Six::Zero();
  };

  Six to_acceleration_;
  Section transition_;  ///< from acceleration to velocity, ISO 5349-1
  Section high_pass_;
  double due_s_ = 0;       ///< time since the filters' last step
  double mean_m2_s4_ = 0;  ///< of the unlowered vibration, at present
  double most_m2_s4_ = 0;  ///< the same, falling with kReturn_s
  State state_;
  int64_t full_at_ns_ = INT64_MIN;
  std::atomic<int64_t> restored_ns_{INT64_MIN};
  std::atomic<int64_t> taken_ns_{0};
};

}  // namespace spidar
