// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Interface of a type of board: its protocol over a transport, without threads.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "spidar/device.h"
#include "spidar/guardian/last_will.h"
#include "spidar/link_fault.h"

namespace spidar {

/// `Output` is what it puts out, `Reading` what it reads. To be used by one thread at a time.
template <typename Output, typename Reading>
class BoardOf {
 public:
  virtual ~BoardOf() = default;

  /// Claims, identifies and resets the board and reads it once with the motors at zero. Throws
  /// DeviceError.
  virtual void open() = 0;

  /// One exchange; gives up at the deadline (CLOCK_MONOTONIC). `reading` is written only if the
  /// result is kNone.
  virtual LinkFault cycle(const Output& output, Reading& reading, int64_t deadline_ns) noexcept = 0;

  /// To be called after a fault, before the next cycle. May block for some milliseconds.
  virtual void recover() noexcept = 0;

  /// The guardian has failed or has zeroed the motors, and close() follows, most likely with
  /// another open(): the board is not to be left as other programs expect it.
  virtual void expect_reopening() noexcept {}

  /// Releases the board; its motors keep their last value.
  virtual void close() noexcept = 0;

  /// Packets that set the motors to zero when this process can no longer do it, one set for each
  /// connection. To be called after open().
  virtual std::vector<LastWill> last_wills() const = 0;

  /// Describes for people what open() found.
  virtual std::string description() const = 0;

  /// Name for messages: "usb:1-2", …
  virtual const std::string& name() const noexcept = 0;
};

/// Motors and encoders: puts out volts, reads counts.
class Board : public BoardOf<MotorVolts, DeviceReading> {
 public:
  /// Sets the counts to zero at the present position of the grip. To be called after open().
  virtual void zero_counts() noexcept = 0;

  /// True if the board's counters have been reset since it was last open, for example because it
  /// had no power, so that they do not determine the position of the grip. Remains true until
  /// zero_counts().
  virtual bool counts_restarted() const noexcept { return false; }

  /// Position of the rotary ID switch; −1 if the board has none. To be called after open().
  virtual int rotary() const noexcept { return -1; }
};

}  // namespace spidar
