// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The interface of a device, and what can go wrong with it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

#include "core/grip/string_geometry.h"
#include "spidar/device_error.h"

namespace spidar {

/// The result of an exchange with a device.
enum class LinkFault : uint8_t {
  kNone,         ///< answered
  kTimeout,      ///< no answer in time
  kStall,        ///< the endpoint rejects the packet
  kShort,        ///< fewer bytes than expected
  kBabble,       ///< more bytes than expected
  kBusError,     ///< broken packets on the wire; often the first fault when a board is unplugged
  kGone,         ///< the device is unplugged
  kWrongReply,   ///< an answer of the right length, but not the expected one
  kWrongEcho,    ///< the board echoes D/A values that were not sent
  kCounterJump,  ///< a counter changed by more than a hand can cause
  kUnguarded,    ///< the guardian has ended, for example because it was killed
  kSuspended,    ///< this process was suspended, so that the guardian set the motors to zero
  kRefused,      ///< the kernel's driver refuses the request
};
constexpr size_t kLinkFaults = 13;

/// Returns whether the device has to be opened again. Other faults may pass.
constexpr bool is_lost(LinkFault fault) noexcept {
  return fault == LinkFault::kGone || fault == LinkFault::kUnguarded ||
         fault == LinkFault::kSuspended;
}

/// Returns "none", "timeout", "stall", "short packet", …
constexpr const char* to_string(LinkFault fault) noexcept {
  switch (fault) {
    case LinkFault::kNone:
      return "none";
    case LinkFault::kTimeout:
      return "timeout";
    case LinkFault::kStall:
      return "stall";
    case LinkFault::kShort:
      return "short packet";
    case LinkFault::kBabble:
      return "babble";
    case LinkFault::kBusError:
      return "bus error";
    case LinkFault::kGone:
      return "unplugged";
    case LinkFault::kWrongReply:
      return "wrong reply";
    case LinkFault::kWrongEcho:
      return "wrong echo";
    case LinkFault::kCounterJump:
      return "counter jump";
    case LinkFault::kUnguarded:
      return "guardian ended";
    case LinkFault::kSuspended:
      return "player stood still";
    case LinkFault::kRefused:
      return "refused by the driver";
  }
  return "unknown";
}

/// Statistics of a link since the device was created.
struct LinkHealth {
  std::array<uint64_t, kLinkFaults> faults{};  ///< by LinkFault; kNone counts successful exchanges
  LinkFault last_fault = LinkFault::kNone;
  /// Answers that came too late for their tick and were used in the next one.
  uint64_t late_replies = 0;
  /// Median time from sending a packet until its answer; 0 if nothing is measured.
  int64_t round_trip_median_ns = 0;
  int64_t round_trip_p99_ns = 0;
  int64_t round_trip_max_ns = 0;

  /// All faults except timeouts.
  uint64_t errors() const noexcept {
    uint64_t sum = 0;
    for (size_t i = 2; i < kLinkFaults; ++i) sum += faults[i];
    return sum;
  }
  uint64_t count(LinkFault fault) const noexcept { return faults[static_cast<size_t>(fault)]; }
};

struct MotorVolts {
  std::array<double, kMaxStrings> volt{};  ///< signed as the D/A converter outputs it
};

/// Returns whether any motor gets a voltage other than zero.
inline bool pulls(const MotorVolts& volts) noexcept {
  for (const double volt : volts.volt) {
    if (volt != 0) return true;
  }
  return false;
}

inline MotorVolts scaled(MotorVolts volts, double fraction) noexcept {
  for (double& volt : volts.volt) volt *= fraction;
  return volts;
}

struct DeviceReading {
  std::array<int32_t, kMaxStrings> count{};  ///< encoder counts, signed as the board gives them
  uint32_t inputs = 0;                       ///< digital inputs, bit 0 first
  /// Time of reading, CLOCK_MONOTONIC; 0 when unknown, which means the time of the tick.
  int64_t read_ns = 0;
};

/// The common interface of a device and a grip. One thread at a time, except where stated.
class Openable {
 public:
  /// `name` is for messages: "sim", "usb:1-2", …
  explicit Openable(std::string name) : name_(std::move(name)) {}
  virtual ~Openable() = default;

  /// Claims the device and reads it once, while no motor pulls. Throws DeviceError. May be called
  /// again after close(), or after a fault that is_lost().
  virtual void open() = 0;

  /// Sets the motors to zero, then releases the device. May be called twice, and after a loss.
  virtual void close() noexcept = 0;

  /// Describes for the user what open() found: "at 1-2: CyVerse USB 2.0 SH4, rotary switch 3".
  /// Empty while closed, and for devices whose name says everything.
  virtual std::string description() const { return {}; }

  /// Returns statistics of the link to the device; all zero without a link. Any thread.
  virtual LinkHealth health() const noexcept { return {}; }

  /// Any thread.
  const std::string& name() const noexcept { return name_; }

 protected:
  const std::string name_;
};

template <typename Output, typename Reading>
class DeviceOf : public Openable {
 public:
  using Openable::Openable;

  /// Performs one cycle. The loop calls this at 1 kHz: no allocation, no lock, no exception. Writes
  /// `reading` only when it returns kNone.
  virtual LinkFault exchange(const Output& output, Reading& reading) noexcept = 0;
};

/// A device with strings: volts out, encoder counts in.
using StringDevice = DeviceOf<MotorVolts, DeviceReading>;

}  // namespace spidar
