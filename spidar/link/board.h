// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Interfaces of the types of boards: their protocols over a transport, without threads.
#pragma once

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

namespace spidar::boards {

/// When the counts are set to zero at the present position of the grip.
enum class CountZero {
  kByProfile,  ///< kNever for a profile with home offsets, otherwise kFirstOpen
  kFirstOpen,  ///< not when a lost board is reopened
  kNever,      ///< keeps the board's counts, to which calibrated home offsets refer
};

struct Settings {
  CountZero count_zero = CountZero::kByProfile;
  /// A separate process zeroes the motors when this one is killed.
  bool guardian = true;
  /// A separate thread makes the exchanges. Without it, exchange() blocks until the board has
  /// answered.
  bool threaded = true;
};

/// A board that puts out an `Output` and reads a `Reading`. open() also identifies and resets the
/// board; when it throws, the caller calls close(), which leaves the motors at their last value.
template <typename Output, typename Reading>
class BoardOf : public Openable {
 public:
  using Openable::Openable;

  /// One exchange; gives up at the deadline (CLOCK_MONOTONIC). `reading` is written only if the
  /// result is kNone.
  virtual LinkFault cycle(const Output& output, Reading& reading, int64_t deadline_ns) noexcept = 0;

  /// To be called after a fault, before the next cycle. May block for some milliseconds.
  virtual void recover() noexcept = 0;

  /// The guardian has failed or has zeroed the motors, and close() follows, most likely with
  /// another open(): the board is not to be left in the state that other programs expect.
  virtual void expect_reopening() noexcept {}

  /// Sets the counts to zero at the present position of the grip. To be called after open().
  virtual void zero_counts() noexcept {}

  /// True if the board's counters have been reset since it was last open, for example because it
  /// had no power, so that they do not determine the position of the grip. Remains true until
  /// zero_counts().
  virtual bool counts_restarted() const noexcept { return false; }

  /// Position of the rotary ID switch; −1 if the board has none. To be called after open().
  virtual int rotary() const noexcept { return -1; }

  /// Packets that set the motors to zero when this process can no longer do it, one set for each
  /// connection. To be called after open().
  virtual std::vector<LastWill> last_wills() const = 0;
};

/// Motors and encoders: puts out volts, reads counts.
using Board = BoardOf<MotorVolts, DeviceReading>;

struct ForceOutput {
  Eigen::Vector3d force_N = Eigen::Vector3d::Zero();  ///< on the hand, device frame
  bool on = false;  ///< forces are switched on, even if there is none at present
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
  PoseFault pose_fault = PoseFault::kNoReading;  ///< why the position is not a number, if it is not
  uint32_t buttons = 0;  ///< the pressed ones; the first button is the lowest bit
  int64_t lag_ns = 0;    ///< from the command of a force to its effect, as the device reports it
  int64_t read_ns = 0;   ///< as in DeviceReading
};

/// A board that exerts forces. It shortens a force that it cannot give; one that is not a number
/// counts as zero.
class ForceBoard : public BoardOf<ForceOutput, ForceReading> {
 public:
  using BoardOf::BoardOf;
  /// See Grip::abilities(). Any thread.
  virtual GripAbilities abilities() const noexcept = 0;
  /// See Grip::warning(). Any thread.
  virtual std::string warning() const { return {}; }
};

/// A board of either type.
using AnyBoard = std::variant<std::unique_ptr<Board>, std::unique_ptr<ForceBoard>>;

}  // namespace spidar::boards
