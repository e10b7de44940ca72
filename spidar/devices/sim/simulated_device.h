// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include <Eigen/Core>

#include "core/grip/string_geometry.h"
#include "core/wrench.h"
#include "spidar/device.h"
#include "spidar/devices/sim/grip_model.h"
#include "spidar/profiles/profile.h"

namespace spidar {

/// The true state, without quantisation.
struct FeltState {
  int64_t time_ns = 0;  ///< simulated time since open()
  StringVector tension_N = StringVector::Zero();
  Wrench wrench;  ///< wrench of the strings on the grip
  Pose pose;
  Eigen::Vector3d velocity_m_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_velocity_rad_s = Eigen::Vector3d::Zero();  ///< in D
};

/// Returns the model of a device with this profile, whose motors lag by drive_lag_s, first order.
GripModel grip_model_of(const Profile& profile);

/// The simulated SPIDAR-G, which is the default device: quantised encoders and D/A converters,
/// motors with lag and saturation, and strings that only pull.
///
/// An exchange takes no time, and its voltages act until the next one. Like a real board, the
/// device holds the voltages when the host stops sending: with kClock the strings keep pulling
/// while time passes, with kFixedStep time stands still between exchanges.
class SimulatedDevice final : public StringDevice {
 public:
  enum class Time {
    kFixedStep,  ///< each exchange is 1 ms after the last, which is deterministic
    kClock,      ///< real time, at most 50 ms per exchange
  };

  /// Throws std::invalid_argument when `model` is not physical or too stiff, see GripDynamics.
  /// `clock` is used with kClock; the default is CLOCK_MONOTONIC.
  SimulatedDevice(const Profile& profile, Time time, const GripModel& model = {},
                  std::function<int64_t()> clock = {});
  ~SimulatedDevice() override;

  /// Puts the grip at rest at the centre, as the user of a real device does. The counters are zero
  /// there, or where the profile's home_offset_m puts them. Throws DeviceError if a fault is set.
  void open() override;

  /// Returns kGone when the device is not open. Voltages of the wrong sign, or not finite, are
  /// zero.
  LinkFault exchange(const MotorVolts& volts, DeviceReading& reading) noexcept override;

  /// Continues the simulation at zero volts until the motor lag has decayed, for at most 50 ms.
  /// Then the power is off and the tensions are zero.
  void close() noexcept override;

  /// Sets the pose of the hand, whose springs pull the grip there. A pose that is not finite is
  /// ignored. Any thread.
  void set_hand(const Pose& pose) noexcept;

  /// Moves the hand to a position in the device frame, at most at GuidedHand::kFastest_m_s and
  /// within the box of the string exits. Without a position, the hand returns to the pose of
  /// set_hand(). A position that is not finite is ignored. Any thread.
  void lead_hand(const std::optional<Eigen::Vector3d>& to_m) noexcept;

  /// Makes every exchange return this fault until a call with kNone. Time goes on meanwhile. With
  /// kTimeout the volts do not reach the motors, with other faults they do; a fault that is_lost()
  /// closes the device. Any thread.
  void set_fault(LinkFault fault) noexcept;

  /// Adds an offset to the encoder of `string` (0 … count − 1), as lost pulses or a slack string
  /// do. Any thread. Throws std::out_of_range.
  void set_count_error(int string, int32_t counts);

  FeltState felt() const noexcept;

  /// Removes the oldest state, one per exchange, for one reader. Returns false when there is none.
  /// The queue keeps up to 4096 states, and drops newer ones while it is full.
  bool pop_felt(FeltState& felt) noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace spidar
