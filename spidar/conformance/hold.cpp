// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/conformance/hold.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "spidar/grip/tension_command.h"
#include "spidar/loop/haptic_loop.h"
#include "spidar/loop/loop_time.h"
#include "spidar/realtime/monotonic.h"

namespace spidar {

std::string loss_text(const std::string& name, LinkFault fault, int64_t late_ns) {
  if (fault == LinkFault::kStoodStill)
    return name + ": this program stood still for " + std::to_string(late_ns / 1'000'000) +
           " ms, because it was stopped or the machine was busy, so its guardian set the motors to "
           "zero; start it again";
  if (fault == LinkFault::kUnguarded)
    return name +
           ": the guardian (spidar-guardian), without which no motor pulls, has ended or does not "
           "answer, and the motors were set to zero; start again";
  return name + ": does not answer any more" +
         (fault == LinkFault::kNone ? "" : std::string(" (") + to_string(fault) + ")") +
         "; check cable and power";
}

void LossWatch::see(ExchangeStatus status, const std::string& name, const LinkHealth& health) {
  const int64_t now_ns = monotonic_now_ns();
  const int64_t late_ns = last_ns_ == 0 ? 0 : now_ns - last_ns_;
  last_ns_ = now_ns;
  errors_in_a_row_ = status == ExchangeStatus::kOk ? 0 : errors_in_a_row_ + 1;
  if (status == ExchangeStatus::kLost || errors_in_a_row_ >= HapticLoop::kMaxErrors)
    throw DeviceError(loss_text(name, health.last_fault, late_ns));
}

StringHold::StringHold(Device& device, const Profile& profile, Pace pace)
    : device_(device), profile_(profile), pace_(std::move(pace)) {
  device_.open();
}

StringHold::~StringHold() {
  device_.close();
}

/// Returns false when there is no new reading.
bool StringHold::exchange() {
  const ExchangeStatus status = device_.exchange(to_volts(tension_N_, profile_), reading_);
  watch_.see(status, device_.name(), device_.health());
  return status == ExchangeStatus::kOk;
}

bool StringHold::go(const StringVector& tension_N, double seconds) {
  const StringVector from_N = tension_N_;
  const StringVector to_N =
      tension_N.cwiseMax(StringVector::Zero()).cwiseMin(profile_.max_tension_N());
  const auto ticks = static_cast<int64_t>(std::max(std::ceil(seconds / kTick_s), 1.0));
  for (int64_t tick = 1; tick <= ticks; ++tick) {
    if (!pace_()) return false;
    const double share = static_cast<double>(tick) / static_cast<double>(ticks);
    tension_N_ = from_N + share * (to_N - from_N);
    exchange();
  }
  return true;
}

bool StringHold::stay(double seconds, const std::function<bool(const DeviceReading&)>& seen) {
  // Half a tick, for the rounding errors of a long sum.
  for (double left_s = seconds; left_s > kTick_s / 2; left_s -= kTick_s) {
    if (!pace_()) return false;
    if (exchange() && seen && !seen(reading_)) return true;
  }
  return true;
}

void StringHold::release() {
  const StringVector from_N = tension_N_;
  constexpr int kTicks = static_cast<int>(HapticLoop::kRelease_s / kTick_s + 0.5);
  for (int left = kTicks - 1; left >= 0; --left) {
    pace_();
    tension_N_ = from_N * left / kTicks;
    exchange();
  }
}

void StringHold::reverse_motor(int string) {
  profile_.drives[static_cast<size_t>(string)].motor_sign *= -1;
}

ForceHold::ForceHold(Grip& grip, Pace pace) : grip_(grip), pace_(std::move(pace)) {
  command_.dt_s = kTick_s;
  grip_.open();
}

ForceHold::~ForceHold() {
  grip_.close();
}

/// Returns false when there is no new reading.
bool ForceHold::exchange() {
  command_.now_ns += kTick_ns;
  const ExchangeStatus status = grip_.exchange(command_);
  watch_.see(status, grip_.name(), grip_.health());
  return status == ExchangeStatus::kOk;
}

bool ForceHold::go(const Eigen::Vector3d& force_N, double seconds) {
  const Eigen::Vector3d from_N = command_.wrench.force_N;
  const auto ticks = static_cast<int64_t>(std::max(std::ceil(seconds / kTick_s), 1.0));
  command_.power = 1;
  command_.fresh = true;
  for (int64_t tick = 1; tick <= ticks; ++tick) {
    if (!pace_()) return false;
    const double share = static_cast<double>(tick) / static_cast<double>(ticks);
    command_.wrench.force_N = from_N + share * (force_N - from_N);
    exchange();
  }
  return true;
}

bool ForceHold::stay(double seconds, const std::function<bool(const GripReading&)>& seen) {
  // Half a tick, for the rounding errors of a long sum.
  for (double left_s = seconds; left_s > kTick_s / 2; left_s -= kTick_s) {
    if (!pace_()) return false;
    if (exchange() && seen && !seen(grip_.reading())) return true;
  }
  return true;
}

}  // namespace spidar
