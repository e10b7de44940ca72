// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Sets string tensions, or the force of a grip, directly, millisecond by millisecond.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include <Eigen/Core>

#include "core/grip/string_geometry.h"
#include "spidar/device.h"
#include "spidar/grip/grip.h"
#include "spidar/profiles/profile.h"

namespace spidar {

/// Waits for the next millisecond. Returns false to end early.
using Pace = std::function<bool()>;

/// Finds out from the results of exchanges that a device is lost, and why.
class LossWatch {
 public:
  /// To be called after every exchange. Throws DeviceError, which says what happened, when the
  /// device is lost, or has not answered for too long.
  void see(ExchangeStatus status, const std::string& name, const LinkHealth& health);

 private:
  int errors_in_a_row_ = 0;
  int64_t last_ns_ = 0;  // when the latest exchange ended
};

/// "usb: does not answer any more (unplugged); check cable and power". If this program was stopped
/// or its guardian ended, that is what the text names. `late_ns`: since the exchange before.
std::string loss_text(const std::string& name, LinkFault fault, int64_t late_ns);

/// Keeps a device open during its lifetime. Tensions change linearly. Every function throws
/// DeviceError when the device is lost.
class StringHold {
 public:
  /// Opens the device with zero tensions. Throws DeviceError.
  StringHold(Device& device, const Profile& profile, Pace pace);
  /// Closes the device, which takes the tensions to zero.
  ~StringHold();
  StringHold(const StringHold&) = delete;
  StringHold& operator=(const StringHold&) = delete;

  /// Ramps to these tensions, in newtons from zero to each string's largest, within the given time.
  /// Returns false when ended early.
  bool go(const StringVector& tension_N, double seconds);

  /// Holds the tensions for the given time, which may be infinite. Calls `seen` with every reading
  /// and ends when it returns false. Returns false when the pace ended it early.
  bool stay(double seconds, const std::function<bool(const DeviceReading&)>& seen = {});

  /// Ramps to zero; does not end early.
  void release();

  /// Reverses the sign of this string's volts. Its tension must be zero.
  void reverse_motor(int string);

  const StringVector& tension_N() const noexcept { return tension_N_; }

 private:
  bool exchange();

  Device& device_;
  Profile profile_;
  const Pace pace_;
  StringVector tension_N_ = StringVector::Zero();
  DeviceReading reading_;
  LossWatch watch_;
};

/// Keeps a grip open during its lifetime. What StringHold is for strings. Every function throws
/// DeviceError when the device is lost.
class ForceHold {
 public:
  /// Opens the grip with forces switched off. Throws DeviceError.
  ForceHold(Grip& grip, Pace pace);
  /// Closes the grip.
  ~ForceHold();
  ForceHold(const ForceHold&) = delete;
  ForceHold& operator=(const ForceHold&) = delete;

  /// Switches forces on, and goes to this one at a constant rate within the given time. Returns
  /// false when ended early.
  bool go(const Eigen::Vector3d& force_N, double seconds);

  /// Holds the force for the given time. Calls `seen` with every reading and ends when it returns
  /// false. Returns false when the pace ended it early.
  bool stay(double seconds, const std::function<bool(const GripReading&)>& seen = {});

 private:
  bool exchange();

  Grip& grip_;
  const Pace pace_;
  GripCommand command_;
  LossWatch watch_;
};

}  // namespace spidar
