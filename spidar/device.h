// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The interface of a device with strings: volts out, counts in.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "core/grip/string_geometry.h"
#include "spidar/device_error.h"
#include "spidar/link_fault.h"

namespace spidar {

struct MotorVolts {
  std::array<double, kMaxStrings> volt{};  ///< signed as the D/A puts it out
};

/// Whether any motor gets something.
inline bool pulls(const MotorVolts& volts) noexcept {
  for (const double volt : volts.volt)
    if (volt != 0) return true;
  return false;
}

inline MotorVolts scaled(MotorVolts volts, double share) noexcept {
  for (double& volt : volts.volt) volt *= share;
  return volts;
}

struct DeviceReading {
  std::array<int32_t, kMaxStrings> count{};  ///< encoder counts, signed as the board gives them
  uint32_t inputs = 0;                       ///< digital inputs, bit 0 first
};

/// One controller board with its motors. One thread at a time.
class Device {
 public:
  virtual ~Device() = default;

  /// Claims the board and reads it once; motors stay at zero. Throws DeviceError. After kLost or
  /// close() it may be called again.
  virtual void open() = 0;

  /// One cycle: puts out volts, reads counts. Called at 1 kHz: no allocation, no lock, no
  /// exception. `reading` is only written with kOk.
  virtual ExchangeStatus exchange(const MotorVolts& volts, DeviceReading& reading) noexcept = 0;

  /// Motors to zero, then releases the board. Safe to call twice, and after kLost.
  virtual void close() noexcept = 0;

  /// A description for people of what open() found: "at 1-2: CyVerse USB 2.0 SH4, rotary switch 3".
  /// Empty while closed, and for devices whose name says everything.
  virtual std::string description() const { return {}; }

  /// Statistics of the link to the board; all zero for a device without one. Any thread.
  virtual LinkHealth health() const noexcept { return {}; }

  /// For messages: "sim", "usb:3", …
  virtual const std::string& name() const noexcept = 0;
};

}  // namespace spidar
