// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/selftest/hold.h"

#include "spidar/chain/tension_command.h"
#include "spidar/loop/haptic_loop.h"
#include "spidar/realtime/monotonic.h"

namespace spidar::selftest {

std::string loss_text(const std::string& name, LinkFault fault, int64_t late_ns) {
  if (fault == LinkFault::kSuspended) {
    const int64_t late_ms = late_ns / 1'000'000;
    return name + ": this program stood still" +
           (late_ms > 0 ? " for " + std::to_string(late_ms) + " ms" : "") +
           ", because it was stopped or the machine was busy, so the motors were set to "
           "zero; start it again";
  }
  if (fault == LinkFault::kUnguarded) {
    return name +
           ": the guardian (spidar-guardian), without which no motor pulls, has ended or does not "
           "answer, and the motors were set to zero; start again";
  }
  return name + ": does not answer any more" +
         (fault == LinkFault::kNone ? "" : std::string(" (") + to_string(fault) + ")") +
         "; check cable and power";
}

template <typename Value, typename Reading>
void Hold<Value, Reading>::watch(LinkFault fault) {
  const int64_t now_ns = monotonic_now_ns();
  const int64_t late_ns = last_ns_ == 0 ? 0 : now_ns - last_ns_;
  last_ns_ = now_ns;
  missing_.count(fault == LinkFault::kNone);
  if (fault == LinkFault::kSuspended) {
    throw ProcessSuspended(loss_text(held_.name(), fault, late_ns));
  }
  if (is_lost(fault) || missing_.is_lost()) {
    throw DeviceError(loss_text(held_.name(), held_.health().last_fault, late_ns));
  }
}

template class Hold<StringVector, DeviceReading>;
template class Hold<Eigen::Vector3d, GripReading>;

StringHold::StringHold(StringDevice& device, const Profile& profile, Pace pace)
    : Hold(device, std::move(pace)), device_(device), profile_(profile) {
  open();
}

void StringHold::open() {
  reset();
  device_.open();
}

LinkFault StringHold::send(const StringVector& tension_N) noexcept {
  const StringVector possible_N =
      tension_N.cwiseMax(StringVector::Zero()).cwiseMin(profile_.max_tension_N());
  return device_.exchange(to_volts(possible_N, profile_), reading_);
}

void StringHold::release() {
  const StringVector from_N = value_;
  constexpr int kTicks = static_cast<int>(HapticLoop::kRelease_s / kTick_s + 0.5);
  try {
    for (int left = kTicks - 1; left >= 0; --left) {
      pace_();
      value_ = from_N * left / kTicks;
      exchange();
    }
  } catch (const ProcessSuspended&) {
    // The motors are already at zero.
  }
}

void StringHold::reverse_motor(int string) {
  profile_.drives[static_cast<size_t>(string)].motor_sign *= -1;
}

ForceHold::ForceHold(Grip& grip, Pace pace) : Hold(grip, std::move(pace)), grip_(grip) {
  command_.dt_s = kTick_s;
  open();
}

void ForceHold::open() {
  reset();
  command_.power = 0;
  command_.fresh = false;
  grip_.open();
}

void ForceHold::release() {
  try {
    ramp_to(Eigen::Vector3d::Zero(), HapticLoop::kRelease_s);
  } catch (const ProcessSuspended&) {
    // The motors are already at zero.
  }
}

LinkFault ForceHold::send(const Eigen::Vector3d& force_N) noexcept {
  command_.now_ns += kTick_ns;
  command_.wrench.force_N = force_N;
  return grip_.exchange(command_);
}

}  // namespace spidar::selftest
