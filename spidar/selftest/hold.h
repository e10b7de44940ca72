// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Sets string tensions, or the force of a grip, directly, millisecond by millisecond.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>

#include <Eigen/Core>

#include "core/grip/string_geometry.h"
#include "spidar/device.h"
#include "spidar/grip/grip.h"
#include "spidar/loop/loop_time.h"
#include "spidar/loop/missing_answers.h"
#include "spidar/profiles/profile.h"

namespace spidar::selftest {

/// Waits for the next millisecond. Returns false to end early.
using Pace = std::function<bool()>;

/// Thrown when this program was stopped or got no processor time for so long that the guardian set
/// the motors to zero. The interrupted part of the test can be repeated, see repeated().
class ProcessSuspended : public DeviceError {
 public:
  using DeviceError::DeviceError;
};

/// Returns a text such as "usb: does not answer any more (unplugged); check cable and power". If
/// this program was stopped or its guardian ended, the text says so. `late_ns` is the time since
/// the previous exchange; 0: unknown.
std::string loss_text(const std::string& name, LinkFault fault, int64_t late_ns);

/// Runs `part` of a test, which begins at rest and takes less than a second. If this program was
/// stopped meanwhile, opens the device of `hold` again, calls `begin`, and repeats the part. Throws
/// ProcessSuspended when that happens each time: nothing can be measured on such a machine.
template <typename AnyHold, typename Begin, typename Part>
bool repeated(AnyHold& hold, const Begin& begin, const Part& part) {
  constexpr int kRepetitions = 10;
  for (int left = kRepetitions;; --left) {
    try {
      if (left < kRepetitions) {
        hold.open();
        if (!begin()) return false;
      }
      return part();
    } catch (const ProcessSuspended&) {
      if (left == 0) throw;
    }
  }
}

/// The common part of StringHold and ForceHold: a value that a ramp changes linearly. Every
/// function throws DeviceError when the device is lost, or has not answered for too long.
template <typename Value, typename Reading>
class Hold {
 public:
  /// Changes to this value within the given time. Returns false when ended early.
  bool ramp_to(const Value& value, double seconds) {
    const Value from = value_;
    const auto ticks = static_cast<int64_t>(std::max(std::ceil(seconds / kTick_s), 1.0));
    for (int64_t tick = 1; tick <= ticks; ++tick) {
      if (!pace_()) return false;
      const double fraction = static_cast<double>(tick) / static_cast<double>(ticks);
      value_ = from + fraction * (value - from);
      exchange();
    }
    return true;
  }

  /// Holds the value for the given time, which may be infinite. Calls `seen` with every reading,
  /// and ends when `seen` returns false. Returns false when the pace ended it early.
  bool hold_for(double seconds, const std::function<bool(const Reading&)>& seen = {}) {
    // Half a tick allows for the rounding errors of a long sum.
    for (double left_s = seconds; left_s > kTick_s / 2; left_s -= kTick_s) {
      if (!pace_()) return false;
      if (exchange() && seen && !seen(reading())) return true;
    }
    return true;
  }

 protected:
  Hold(Openable& device, Pace pace) : pace_(std::move(pace)), held_(device) {}
  /// Closes the device, which ramps the value to zero.
  ~Hold() { held_.close(); }
  Hold(const Hold&) = delete;
  Hold& operator=(const Hold&) = delete;

  virtual LinkFault send(const Value& value) noexcept = 0;
  virtual const Reading& reading() const noexcept = 0;

  bool exchange() {
    const LinkFault fault = send(value_);
    watch(fault);
    return fault == LinkFault::kNone;
  }

  /// Sets the value to zero without a ramp.
  void reset() {
    value_ = Value::Zero();
    missing_.reset();
    last_ns_ = 0;
  }

  const Pace pace_;
  Value value_ = Value::Zero();

 private:
  void watch(LinkFault fault);

  Openable& held_;
  MissingAnswers missing_;
  int64_t last_ns_ = 0;  ///< end of the latest exchange
};

/// Keeps a device open during the lifetime of this object, and its strings at tensions in newtons.
class StringHold final : public Hold<StringVector, DeviceReading> {
 public:
  /// Opens the device with zero tensions. Throws DeviceError.
  StringHold(StringDevice& device, const Profile& profile, Pace pace);

  void open();

  /// Ramps to zero, and does not end early.
  void release();

  /// Reverses the sign of this string's volts. Its tension must be zero.
  void reverse_motor(int string);

 private:
  LinkFault send(const StringVector& tension_N) noexcept override;
  const DeviceReading& reading() const noexcept override { return reading_; }

  StringDevice& device_;
  Profile profile_;
  DeviceReading reading_;
};

/// Keeps a grip open during the lifetime of this object, with a force on it. ramp_to() switches the
/// force on.
class ForceHold final : public Hold<Eigen::Vector3d, GripReading> {
 public:
  /// Opens the grip with forces switched off. Throws DeviceError.
  ForceHold(Grip& grip, Pace pace);

  void open();
  void release();

  bool ramp_to(const Eigen::Vector3d& force_N, double seconds) {
    command_.power = 1;
    command_.fresh = true;
    return Hold::ramp_to(force_N, seconds);
  }

 private:
  LinkFault send(const Eigen::Vector3d& force_N) noexcept override;
  const GripReading& reading() const noexcept override { return grip_.reading(); }

  Grip& grip_;
  GripCommand command_;
};

}  // namespace spidar::selftest
