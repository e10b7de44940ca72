// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/loop/wrench_callback.h"

#include <chrono>
#include <cmath>
#include <cstring>
#include <exception>
#include <limits>
#include <thread>
#include <utility>

#include "spidar/loop/stiffness_limit.h"
#include "spidar/realtime/monotonic.h"

namespace spidar {
namespace {

touch::ForcePath path_of(const SafetyLimits& limits, double drive_lag_s) noexcept {
  touch::ForcePath path;
  path.max_force_N = limits.max_force_N;
  path.max_slew_N_s = limits.max_slew_N_s;
  path.lag_s = drive_lag_s;
  path.velocity_lag_s = surface_delay_s(drive_lag_s) + 1 / (2 * M_PI * GripMotion::kCutoff_Hz);
  return path;
}

}  // namespace

void WrenchCallback::set(Function function, bool passive, double drive_lag_s) {
  std::unique_ptr<Called> next;
  if (function) {
    next = std::make_unique<Called>(Called{std::move(function), passive, drive_lag_s, ++set_});
  }
  called_.store(nullptr);
  while (running_.load() != nullptr) std::this_thread::sleep_for(std::chrono::microseconds(50));
  owned_ = std::move(next);
  state_.store(owned_ ? State::kRuns : State::kNone, std::memory_order_release);
  called_.store(owned_.get());
}

Wrench WrenchCallback::call(const CallbackInput& input, const Eigen::Vector3d& beside_N,
                            const SafetyLimits& limits) noexcept {
  Called* const called = called_.load();
  if (called == nullptr) return {};
  // From here on, set() waits, unless it has removed the function in between.
  running_.store(called);
  if (called_.load() != called) {
    running_.store(nullptr);
    return {};
  }
  if (last_ != called->number) {
    last_ = called->number;
    slow_in_a_row_ = 0;
    rest();
  }
  Wrench wrench = call_function(*called, input);
  // The safety chain refuses a wrench that is not finite.
  if (called->passive && wrench.is_finite()) {
    wrench = bounded(wrench, input, beside_N, path_of(limits, called->drive_lag_s));
  }
  running_.store(nullptr);
  return wrench;
}

Wrench WrenchCallback::call_function(const Called& called, const CallbackInput& input) noexcept {
  const int64_t begin_ns = monotonic_now_ns();
  Wrench wrench;
  try {
    wrench = called.function(input);
  } catch (const std::exception& error) {
    std::strncpy(thrown_.data(), error.what(), thrown_.size() - 1);
    stop(State::kThrew);
    return {};
  } catch (...) {
    thrown_.front() = '\0';
    stop(State::kThrew);
    return {};
  }
  slow_in_a_row_ = monotonic_now_ns() - begin_ns > kLongest_ns ? slow_in_a_row_ + 1 : 0;
  if (slow_in_a_row_ >= kSlowInARow) stop(State::kTooSlow);
  return wrench;
}

void WrenchCallback::stop(State why) noexcept {
  Called* called = running_.load();
  // If set() has already removed the function, there is nothing to report.
  if (called_.compare_exchange_strong(called, nullptr)) {
    state_.store(why, std::memory_order_release);
  }
}

/// Drops the torque, and limits the force to the energy that the hand has put in since the force
/// was last zero.
Wrench WrenchCallback::bounded(const Wrench& wanted, const CallbackInput& input,
                               const Eigen::Vector3d& beside_N,
                               const touch::ForcePath& path) noexcept {
  constexpr double kAny_J = std::numeric_limits<double>::infinity();
  const Eigen::Vector3d& grip_m = input.pose.position_m;
  const Eigen::Vector3d moved_m = has_position_ ? grip_m - position_m_ : Eigen::Vector3d(0, 0, 0);
  position_m_ = grip_m;
  has_position_ = true;
  budget_.update(moved_m, input.velocity.linear_m_s, 0, pushes_ ? kAny_J : 0);
  Wrench passive;
  passive.force_N = wanted.force_N * budget_.allowed_fraction(wanted.force_N, path, input.dt_s);
  pushes_ = !passive.force_N.isZero(0);
  budget_.command(passive.force_N, beside_N, path, input.dt_s);
  return passive;
}

}  // namespace spidar
