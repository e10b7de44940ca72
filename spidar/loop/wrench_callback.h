// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>

#include "core/touch/energy_budget.h"
#include "core/wrench.h"
#include "spidar/grip/grip.h"

namespace spidar {

struct CallbackInput {
  Pose pose;
  GripVelocity velocity;  ///< GripMotion::kLag_s behind the pose
  double dt_s = 0;        ///< since the last tick
  uint32_t buttons = 0;   ///< as GripReport::buttons
};

/// A function of the application that the loop calls in every tick to get a wrench. One thread sets
/// the function, and the loop calls it. A function that throws, or takes longer than kLongest_ns
/// kSlowInARow times in a row, is not called again.
class WrenchCallback {
 public:
  using Function = std::function<Wrench(const CallbackInput&)>;

  static constexpr int64_t kLongest_ns = 500'000;
  static constexpr int kSlowInARow = 20;  ///< fewer may be due to the scheduler

  enum class State { kNone, kRuns, kThrew, kTooSlow };

  ~WrenchCallback() { set({}); }

  /// Replaces the function; an empty one removes it. When this returns, the previous function no
  /// longer runs. Must not be called from within the function. May allocate. If `passive`, the hand
  /// gets no more energy than it has put in since the function last returned no force, and there is
  /// no torque; this needs `drive_lag_s` ≥ 0, the lag of the device.
  void set(Function function, bool passive = true, double drive_lag_s = 0.005);

  State state() const noexcept { return state_.load(std::memory_order_acquire); }
  /// With kThrew: what() of the exception, shortened to fit; "" if it was not a std::exception.
  const char* thrown() const noexcept { return thrown_.data(); }

  // --- loop thread

  bool is_set() const noexcept { return called_.load(std::memory_order_relaxed) != nullptr; }

  /// Returns the wrench of this tick. The safety chain applies `limits` to its sum with `beside_N`,
  /// the other force of the tick.
  Wrench call(const CallbackInput& input, const Eigen::Vector3d& beside_N,
              const SafetyLimits& limits) noexcept;

  /// Call this after call(), with the wrench that the device exerts, see touch::EnergyBudget.
  void set_delivered(const Wrench& given, const Eigen::Vector3d& turn_rad) noexcept {
    budget_.set_delivered(given, turn_rad);
  }

  /// Call this in a tick in which the pose is unknown or the loop is closing.
  void rest() noexcept {
    budget_ = {};
    has_position_ = false;
  }

 private:
  struct Called {
    Function function;
    bool passive;
    double drive_lag_s;
    uint64_t number;  // 1 for the first
  };

  Wrench call_function(const Called& called, const CallbackInput& input) noexcept;
  Wrench bounded(const Wrench& wanted, const CallbackInput& input, const Eigen::Vector3d& beside_N,
                 const touch::ForcePath& path) noexcept;
  void stop(State why) noexcept;

  std::unique_ptr<Called> owned_;
  uint64_t set_ = 0;  ///< number of functions so far
  std::atomic<Called*> called_{nullptr};
  std::atomic<Called*> running_{nullptr};  ///< the function that is being called; null if none
  std::atomic<State> state_{State::kNone};
  std::array<char, 160> thrown_{};
  // Loop thread only.
  int slow_in_a_row_ = 0;
  uint64_t last_ = 0;  ///< number of the last called function
  touch::EnergyBudget budget_;
  Eigen::Vector3d position_m_ = Eigen::Vector3d::Zero();
  bool has_position_ = false;
  bool pushes_ = false;  ///< whether the last wrench had a force
};

}  // namespace spidar
