// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A SPIDAR-G that exists only as equations; the default device.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include <Eigen/Core>

#include "core/api.h"
#include "core/grip/pose.h"
#include "core/wrench.h"
#include "spidar/device.h"
#include "spidar/profiles/profile.h"
#include "spidar/simulation/grip_model.h"

namespace spidar {

/// What the hand and the motors really got.
struct FeltState {
  int64_t time_ns = 0;  ///< simulated time since open()
  StringVector tension_N = StringVector::Zero();
  Wrench wrench;  ///< of the strings on the grip
  Pose pose;
  Eigen::Vector3d velocity_m_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_velocity_rad_s = Eigen::Vector3d::Zero();  ///< in D
};

/// Encoders are quantised, the D/A has its resolution, motors lag and saturate, strings only pull.
///
/// An exchange is an instant: its volts act until the next one. Like the real boards it keeps them
/// when the host goes silent: with kClock the strings pull on for the time that passed, with
/// kFixedStep time stands still between exchanges.
class SPIDAR_API SimulatedDevice final : public Device {
 public:
  enum class Time {
    kFixedStep,  ///< each exchange is 1 ms after the last: deterministic
    kClock,      ///< the time that has really passed, at most 50 ms
  };

  /// Throws std::invalid_argument when `model` is not physical or too stiff, see GripDynamics.
  SimulatedDevice(const Profile& profile, Time time, const GripModel& model = {});
  ~SimulatedDevice() override;

  /// Puts the grip at rest at the centre, as the user of a real device does. The counters are zero
  /// there, or where the profile's home_offset_m says. Throws DeviceError for as long as a fault
  /// stands.
  void open() override;

  /// kLost when not open. Volts that are not finite or point the wrong way count as zero.
  ExchangeStatus exchange(const MotorVolts& volts, DeviceReading& reading) noexcept override;

  /// Simulates on with zero volts until the motors' lag has run out, 50 ms at most; then the power
  /// is off and the tensions are zero.
  void close() noexcept override;

  const std::string& name() const noexcept override;

  /// Where the hand wants to be; the grip is pulled there by the hand's spring. A pose that is not
  /// finite is ignored. Any thread.
  void set_hand(const Pose& pose) noexcept;

  /// Makes every exchange answer like this until it is called with kOk. Time passes all the same:
  /// with kTimeout the volts do not reach the motors, with kBadReply they do. kLost closes the
  /// device. Any thread.
  void set_fault(ExchangeStatus fault) noexcept;

  /// From now on the encoder of `string` (0 … count − 1) says this many counts more: pulses that
  /// were lost, or string that is slack. Any thread. Throws std::out_of_range.
  void set_count_error(int string, int32_t counts);

  /// Newest state; any thread.
  FeltState felt() const noexcept;

  /// Every state in order, one an exchange, for one reader. False when there is none. 4096 are
  /// kept; newer ones are dropped when nobody reads.
  bool pop_felt(FeltState& felt) noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace spidar
