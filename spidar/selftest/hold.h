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

/// This program got no processor time, or was stopped, for so long that the guardian has set the
/// motors to zero. The part of the test that was begun can be repeated, see repeated().
class StoodStill : public DeviceError {
 public:
  using DeviceError::DeviceError;
};

/// "usb: does not answer any more (unplugged); check cable and power". If this program was stopped
/// or its guardian ended, that is what the text names. `late_ns`: time since the previous exchange;
/// 0: not known.
std::string loss_text(const std::string& name, LinkFault fault, int64_t late_ns);

/// Runs `part` of a test, which begins at rest and takes less than a second. If this program stood
/// still meanwhile, opens the device of `hold` again, calls `begin`, and repeats the part. Throws
/// StoodStill when that happens each time: nothing can be measured on such a machine.
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
    } catch (const StoodStill&) {
      if (left == 0) throw;
    }
  }
}

/// What the holds of strings and of a grip have in common. The value changes linearly. Every
/// function throws DeviceError, which says what happened, when the device is lost, or has not
/// answered for too long.
template <typename Value, typename Reading>
class Hold {
 public:
  /// Goes to this value within the given time. Returns false when ended early.
  bool go(const Value& value, double seconds) {
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

  /// Holds the value for the given time, which may be infinite. Calls `seen` with every reading and
  /// ends when it returns false. Returns false when the pace ended it early.
  bool stay(double seconds, const std::function<bool(const Reading&)>& seen = {}) {
    // Half a tick, for the rounding errors of a long sum.
    for (double left_s = seconds; left_s > kTick_s / 2; left_s -= kTick_s) {
      if (!pace_()) return false;
      if (exchange() && seen && !seen(reading())) return true;
    }
    return true;
  }

 protected:
  Hold(Openable& device, Pace pace) : pace_(std::move(pace)), held_(device) {}
  /// Closes the device, which takes the value to zero.
  ~Hold() { held_.close(); }
  Hold(const Hold&) = delete;
  Hold& operator=(const Hold&) = delete;

  virtual LinkFault put_out(const Value& value) noexcept = 0;
  virtual const Reading& reading() const noexcept = 0;

  /// Returns false when there is no new reading.
  bool exchange() {
    const LinkFault fault = put_out(value_);
    watch(fault);
    return fault == LinkFault::kNone;
  }

  /// Forgets what was put out: the value is zero.
  void reset() {
    value_ = Value::Zero();
    missing_.reset();
    last_ns_ = 0;
  }

  const Pace pace_;
  Value value_ = Value::Zero();

 private:
  /// Throws DeviceError.
  void watch(LinkFault fault);

  Openable& held_;
  MissingAnswers missing_;
  int64_t last_ns_ = 0;  ///< when the latest exchange ended
};

/// Keeps a device open during its lifetime, and its strings at tensions in newtons.
class StringHold final : public Hold<StringVector, DeviceReading> {
 public:
  /// Opens the device with zero tensions. Throws DeviceError.
  StringHold(StringDevice& device, const Profile& profile, Pace pace);

  /// Opens the device again after it was lost.
  void open();

  /// Ramps to zero; does not end early.
  void release();

  /// Reverses the sign of this string's volts. Its tension must be zero.
  void reverse_motor(int string);

 private:
  LinkFault put_out(const StringVector& tension_N) noexcept override;
  const DeviceReading& reading() const noexcept override { return reading_; }

  StringDevice& device_;
  Profile profile_;
  DeviceReading reading_;
};

/// Keeps a grip open during its lifetime, and a force on it. The force is switched on by go().
class ForceHold final : public Hold<Eigen::Vector3d, GripReading> {
 public:
  /// Opens the grip with forces switched off. Throws DeviceError.
  ForceHold(Grip& grip, Pace pace);

  /// Opens the grip again after it was lost, with forces switched off.
  void open();
  /// Ramps to zero.
  void release();

  bool go(const Eigen::Vector3d& force_N, double seconds) {
    command_.power = 1;
    command_.fresh = true;
    return Hold::go(force_N, seconds);
  }

 private:
  LinkFault put_out(const Eigen::Vector3d& force_N) noexcept override;
  const GripReading& reading() const noexcept override { return grip_.reading(); }

  Grip& grip_;
  GripCommand command_;
};

}  // namespace spidar::selftest
