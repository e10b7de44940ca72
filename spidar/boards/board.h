// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A kind of board: its protocol over a transport, without threads.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/api.h"
#include "spidar/device.h"
#include "spidar/guardian/last_will.h"
#include "spidar/transports/link_fault.h"

namespace spidar {

/// One thread at a time.
class SPIDAR_API Board {
 public:
  virtual ~Board() = default;

  /// Claims, identifies and resets the board and reads it once, its motors at zero. Throws
  /// DeviceError.
  virtual void open() = 0;

  /// Puts out volts, reads counts; gives up at the deadline (CLOCK_MONOTONIC). `reading` is only
  /// written with kNone.
  virtual LinkFault cycle(const MotorVolts& volts, DeviceReading& reading,
                          int64_t deadline_ns) noexcept = 0;

  /// After a fault, before the next cycle. May block for some milliseconds.
  virtual void recover() noexcept = 0;

  /// From now on counts are zero where the grip is. After open().
  virtual void zero_counts() noexcept = 0;

  /// The board's counters have begun anew since it was open before, as they do without power: they
  /// do not say where the grip is. Until zero_counts().
  virtual bool counts_restarted() const noexcept { return false; }

  /// Releases the board; its motors keep what they have.
  virtual void close() noexcept = 0;

  /// What takes the motors to zero when this process cannot any more: one for each connection.
  /// After open().
  virtual std::vector<LastWill> last_wills() const = 0;

  /// What open() found, for people.
  virtual std::string description() const = 0;

  /// Rotary ID switch; −1 when the board has none. After open().
  virtual int rotary() const noexcept { return -1; }

  /// For messages: "usb:1-2", …
  virtual const std::string& name() const noexcept = 0;
};

}  // namespace spidar
