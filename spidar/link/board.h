// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The interfaces of boards: their protocols over a transport, without threads.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <Eigen/Core>

#include "spidar/device.h"
#include "spidar/grip/grip.h"
#include "spidar/grip/pose_trust.h"
#include "spidar/guardian/guardian.h"
#include "spidar/link/encoder_counts.h"
#include "spidar/realtime/monotonic.h"

namespace spidar::boards {

/// When the counts are set to zero at the present position of the grip.
enum class CountZero {
  kByProfile,  ///< kNever for a profile with home offsets, otherwise kFirstOpen
  kFirstOpen,  ///< at the first opening, not when a lost board is reopened
  kNever,      ///< keeps the board's counts, to which calibrated home offsets refer
};

struct Settings {
  CountZero count_zero = CountZero::kByProfile;
  bool guardian = true;  ///< a separate process sets the motors to zero when this one is killed
  /// A separate thread makes the exchanges; otherwise exchange() blocks until the board answers.
  bool threaded = true;
};

/// A board that takes an `Output` and returns a `Reading`. A driver implements these functions. One
/// thread at a time.
template <typename OutputType, typename ReadingType>
class BoardOf {
 public:
  using Output = OutputType;
  using Reading = ReadingType;

  /// `name` is for messages: "usb:1-2".
  explicit BoardOf(std::string name) : name_(std::move(name)) {}
  virtual ~BoardOf() = default;

  /// Claims, identifies and resets the board, and reads it once, while no motor pulls. Throws
  /// DeviceError; the caller then calls close(). May be called again after close().
  virtual void open() = 0;

  /// Performs one exchange; gives up at the deadline (CLOCK_MONOTONIC). Writes `reading` only if
  /// the result is kNone.
  virtual LinkFault cycle(const Output& output, Reading& reading, int64_t deadline_ns) noexcept = 0;

  /// Call this after a fault, before the next cycle. May block for some milliseconds.
  virtual void recover() noexcept = 0;

  /// Releases the board and leaves the motors at their last value. May be called twice.
  virtual void close() noexcept = 0;

  /// Returns packets that set the motors to zero when this process can no longer do so, one set for
  /// each connection. Call this after open().
  virtual std::vector<LastWill> last_wills() const = 0;

  /// Describes for the user what open() found: "at 1-2: CyVerse USB 2.0 SH4, rotary switch 3".
  virtual std::string description() const = 0;

  const std::string& name() const noexcept { return name_; }

  /// The position of the rotary ID switch; −1 if the board has none. Call this after open().
  int rotary() const noexcept { return rotary_; }

  /// Call this when the guardian has failed or has set the motors to zero. close() follows, most
  /// likely with another open(), so the board must not return to the state for other programs.
  void expect_reopening() noexcept { reopening_ = true; }

 protected:
  const std::string name_;
  int rotary_ = -1;
  bool reopening_ = false;
};

/// Motors and encoders: takes volts, returns counts.
class Board : public BoardOf<MotorVolts, DeviceReading> {
 public:
  Board(std::string name, int counter_bits) : BoardOf(std::move(name)), counts_(counter_bits) {}
  EncoderCounts& counts() noexcept { return counts_; }

 protected:
  /// Updates the counts with the counters of an answer.
  LinkFault update_counts(const std::array<uint32_t, kMaxStrings>& counters,
                          DeviceReading& reading) noexcept {
    if (!counts_.update(counters, monotonic_now_ns())) return LinkFault::kCounterJump;
    reading.count = counts_.counts();
    return LinkFault::kNone;
  }

  EncoderCounts counts_;
};

struct ForceOutput {
  Eigen::Vector3d force_N = Eigen::Vector3d::Zero();  ///< on the hand, device frame
  bool on = false;  ///< forces are switched on, even if the force is zero at present
};

inline bool pulls(const ForceOutput& output) noexcept {
  return output.on || !output.force_N.isZero(0);
}

inline ForceOutput scaled(ForceOutput output, double fraction) noexcept {
  output.force_N *= fraction;
  return output;
}

struct ForceReading {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  ///< of the grip, device frame
  /// Why there is no position; kNone if there is one.
  PoseFault pose_fault = PoseFault::kNoReading;
  uint32_t buttons = 0;  ///< the pressed ones; the first button is the lowest bit
  int64_t lag_ns = 0;    ///< lag from a command to its force, as the device reports it
  int64_t read_ns = 0;   ///< as in DeviceReading
};

/// A board that exerts forces. The board reduces a force that exceeds its range; a force that is
/// not a number counts as zero.
class ForceBoard : public BoardOf<ForceOutput, ForceReading> {
 public:
  using BoardOf::BoardOf;
  /// See Grip::abilities(). Any thread.
  virtual GripAbilities abilities() const noexcept = 0;
  /// See Grip::warning(). Any thread.
  virtual std::string warning() const { return {}; }
};

using AnyBoard = std::variant<std::unique_ptr<Board>, std::unique_ptr<ForceBoard>>;

}  // namespace spidar::boards
