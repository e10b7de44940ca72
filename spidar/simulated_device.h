/// A SPIDAR-G that exists only as equations; the default device.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include <Eigen/Core>

#include "core/api.h"
#include "core/pose.h"
#include "core/wrench.h"
#include "spidar/device.h"
#include "spidar/profile.h"

namespace spidar {

/// Rigid grip on strings, held by a hand. The hand carries the grip's weight.
struct GripModel {
  double mass_kg = 0.10;
  double inertia_kg_m2 = 4e-5;        ///< solid sphere of that mass and 32 mm radius
  double hand_stiffness_N_m = 300.0;  ///< relaxed grasp
  double hand_damping_N_s_m = 8.0;
  double hand_stiffness_Nm_rad = 1.5;
  double hand_damping_Nm_s_rad = 0.02;
  double motor_time_constant_s = 0.002;  ///< first-order lag from volts to tension
};

/// What the hand and the motors really got.
struct FeltState {
  int64_t time_ns = 0;  ///< simulated time since open()
  StringVector tension_N = StringVector::Zero();
  Wrench wrench;  ///< of the strings on the grip
  Pose pose;
  Eigen::Vector3d velocity_m_s = Eigen::Vector3d::Zero();
};

/// Encoders are quantised, the D/A has its resolution, motors lag and saturate, strings only pull.
class SPIDAR_API SimulatedDevice final : public Device {
 public:
  enum class Time {
    kFixedStep,  ///< each exchange is 1 ms: deterministic
    kClock,      ///< the time that has really passed since the last exchange, at most 50 ms
  };

  SimulatedDevice(const Profile& profile, Time time, const GripModel& model = {});
  ~SimulatedDevice() override;

  void open() override;
  ExchangeStatus exchange(const MotorVolts& volts, DeviceReading& reading) noexcept override;
  void close() noexcept override;
  const std::string& name() const noexcept override;

  /// Where the hand wants to be; the grip is pulled there by the hand's spring. Any thread.
  void set_hand(const Pose& pose) noexcept;

  /// Makes every exchange answer like this until it is called with kOk; kLost closes the device and
  /// open() fails for as long as the fault stands. Any thread.
  void set_fault(ExchangeStatus fault) noexcept;

  /// Newest state; any thread.
  FeltState felt() const noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace spidar
