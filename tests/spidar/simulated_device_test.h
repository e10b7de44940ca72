// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Shared by the tests of the simulated device.
#pragma once

#include "spidar/devices/sim/simulated_device.h"
#include "spidar/profiles/profile.h"
#include "tests/support/test.h"

namespace spidar::test {

inline GripModel without_lag() {
  GripModel model;
  model.motor_time_constant_s = 0;
  return model;
}

/// Volts for a tension of every string, before the D/A rounds them.
inline MotorVolts volts_for(const Profile& profile, const StringVector& tension_N) {
  MotorVolts volts;
  for (int i = 0; i < profile.geometry.count; ++i) {
    const auto k = static_cast<size_t>(i);
    const StringDrive& drive = profile.drives[k];
    volts.volt[k] = drive.motor_sign * tension_N[i] / drive.newtons_per_volt;
  }
  return volts;
}

/// The D/A's step as a tension of string `i`.
inline double step_N(const Profile& profile, int i) {
  return profile.dac_max_V / ((1 << profile.dac_bits) - 1) *
         profile.drives[static_cast<size_t>(i)].newtons_per_volt;
}

inline Pose hand_at(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  Pose hand;
  hand.position_m = 0.02 * Eigen::Vector3d(unit(random), unit(random), unit(random));
  hand.orientation = Eigen::Quaterniond(Eigen::AngleAxisd(
      unit(random), Eigen::Vector3d(unit(random), unit(random), unit(random)).normalized()));
  return hand;
}

/// The default profile, stepped a millisecond an exchange.
class SimulatedDeviceTest : public testing::Test {
 protected:
  static constexpr auto kFixedStep = SimulatedDevice::Time::kFixedStep;

  const Profile profile = load_profile(kDefaultProfile);
};

}  // namespace spidar::test
