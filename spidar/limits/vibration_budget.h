// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>

#include <Eigen/Core>

#include "core/wrench.h"

namespace spidar {

/// Measures the vibration that the strings cause, and computes the fraction of the force that keeps
/// it within the daily limit.
///
/// The alternating part of the force, divided by kMoved_kg, is an acceleration. It is weighted with
/// W_h of ISO 5349-1, squared and integrated. A torque counts as the force at the grip's radius
/// that causes it. The weight is 0.03 at 1 Hz, 0.25 at 3 Hz, most at 12 Hz, and falls as 1/f above
/// that, so a slow force hardly counts.
///
/// The vibration empties a store of kStore_m2_s3, which is refilled with kRefill_m2_s4. In any
/// 24 hours a hand therefore gets at most kStore_m2_s3 + 24 h · kRefill_m2_s4, which is the daily
/// action value of Directive 2002/44/EC: 2.5 m/s² for eight hours. The fraction falls so that the
/// vibration takes at most 1/kEmptied_s of the rest each second, and is 1 as long as this is no
/// restriction.
class VibrationBudget {
 public:
  struct State {
    /// The fraction of the wanted wrench, within its limits, that may be exerted, 0 … 1.
    double fraction = 1;
    /// The fraction of the store that is left, 0 … 1.
    double left = 1;

    /// Whether the force is lowered by enough for a hand to notice: 7 %.
    bool lowered() const noexcept { return fraction < 0.93; }
  };

  static constexpr double kActionValue_m_s2 = 2.5;
  static constexpr double kDay_m2_s3 = kActionValue_m_s2 * kActionValue_m_s2 * 8 * 3600;
  static constexpr double kStore_m2_s3 = kDay_m2_s3 / 2;
  static constexpr double kRefill_m2_s4 = (kDay_m2_s3 - kStore_m2_s3) / (24 * 3600);
  static constexpr double kEmptied_s = 60;
  /// The vibration that is always permitted, a quarter of the refill: 0.51 m/s².
  static constexpr double kAlways_m2_s4 = kRefill_m2_s4 / 4;
  /// A lowered force returns with this time constant.
  static constexpr double kReturn_s = 20;
  /// The mass that the force moves: that of a grip alone, which is conservative. ISO 10068 has
  /// values for the hand, but for handles that are gripped with 25 N or more.
  static constexpr double kMoved_kg = 0.1;
  static constexpr double kTick_s = 1e-3;

  /// `grip_radius_m` converts torques to forces; 0: torques do not count.
  explicit VibrationBudget(double grip_radius_m) noexcept;

  /// Adds the wrench `strings` of a tick, `passed_s` after the last one. The filters run in steps
  /// of kTick_s, however irregular the ticks are. `now_ns` must increase.
  void update(const Wrench& strings, double passed_s, int64_t now_ns) noexcept;

  double fraction() const noexcept { return state_.fraction; }
  const State& state() const noexcept { return state_; }

  /// When the store will be full again without more vibration, on the clock of update().
  int64_t full_at_ns() const noexcept {
    return std::max(full_at_ns_, restored_ns_.load(std::memory_order_relaxed));
  }
  /// From the next update() on, the store will not be full before this time. Any thread.
  void restore(int64_t full_at_ns) noexcept {
    restored_ns_.store(full_at_ns, std::memory_order_relaxed);
  }
  /// The total vibration so far, as the time that refilling takes. Any thread.
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
  double mean_m2_s4_ = 0;  ///< mean square of the acceleration at full force
  double most_m2_s4_ = 0;  ///< the same, falling with kReturn_s
  State state_;
  int64_t full_at_ns_ = INT64_MIN;
  std::atomic<int64_t> restored_ns_{INT64_MIN};
  std::atomic<int64_t> taken_ns_{0};
};

}  // namespace spidar
