// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The readings of the simulated device: quantised, saturated, in equilibrium, and repeatable.

#include "tests/spidar/simulated_device_test.h"
#include "tests/support/test.h"

namespace spidar::test::simulated_device_test {

TEST_F(SimulatedDeviceTest, CountsAreWithinHalfACountOfTheLengths) {
  constexpr unsigned kSeed = 1;
  std::mt19937 random(kSeed);
  SimulatedDevice device(profile, kFixedStep);
  device.open();
  const StringVector home_m = string_lengths_m(profile.geometry, {});
  double largest = 0;
  for (int tick = 0; tick < 5000; ++tick) {
    if (tick % 50 == 0) device.set_hand(hand_at(random));
    DeviceReading reading;
    ASSERT_EQ(device.exchange({}, reading), LinkFault::kNone);
    const StringVector change_m = string_lengths_m(profile.geometry, device.felt().pose) - home_m;
    for (int i = 0; i < profile.geometry.count; ++i) {
      const StringDrive& drive = profile.drives[static_cast<size_t>(i)];
      const double counted_m =
          drive.encoder_sign * drive.metres_per_count * reading.count[static_cast<size_t>(i)];
      const double error = std::abs(counted_m - change_m[i]) / drive.metres_per_count;
      // Half a count, and rounding of lengths of 0.1 m.
      ASSERT_LE(error, 0.5 + 1e-9) << "seed " << kSeed << ", tick " << tick << ", string " << i;
      largest = std::max(largest, error);
    }
  }
  // 40 000 lengths leave no part of a count unvisited: otherwise nothing was quantised.
  EXPECT_GT(largest, 0.49);
}

TEST_F(SimulatedDeviceTest, TensionsHaveTheStepsOfTheDA) {
  SimulatedDevice device(profile, kFixedStep, without_lag());
  device.open();
  const double step = step_N(profile, 2);
  for (int quarter = 0; quarter <= 400; ++quarter) {
    const double wanted_N = quarter * step / 4;
    StringVector tension_N = StringVector::Zero();
    tension_N[2] = wanted_N;
    DeviceReading reading;
    device.exchange(volts_for(profile, tension_N), reading);
    device.exchange(volts_for(profile, tension_N), reading);  // the first one's volts have acted
    const double got_N = device.felt().tension_N[2];
    EXPECT_LE(std::abs(got_N - wanted_N), step / 2 * (1 + 1e-9)) << quarter;
    const double steps = got_N / step;
    EXPECT_NEAR(steps, std::round(steps), 1e-9) << quarter;
  }
}

TEST_F(SimulatedDeviceTest, MotorsSaturateAndStringsNeverPush) {
  SimulatedDevice device(profile, kFixedStep, without_lag());
  device.open();
  const double infinity = std::numeric_limits<double>::infinity();
  const StringVector max_N = profile.max_tension_N();
  MotorVolts volts = volts_for(profile, StringVector::Constant(1.0));
  volts.volt[0] *= 1e6;             // far beyond the D/A
  volts.volt[1] *= max_N[1] + 0.5;  // within the D/A, more than the motor can do
  volts.volt[2] *= -1;              // pushes
  volts.volt[3] = std::nan("");
  volts.volt[4] = infinity;
  volts.volt[5] = -infinity;
  ASSERT_LT(std::abs(volts.volt[1]), profile.dac_max_V);
  DeviceReading reading;
  for (int tick = 0; tick < 2; ++tick) device.exchange(volts, reading);
  const StringVector tension_N = device.felt().tension_N;
  EXPECT_EQ(tension_N[0], max_N[0]);
  EXPECT_EQ(tension_N[1], max_N[1]);
  for (int i = 2; i <= 5; ++i) EXPECT_EQ(tension_N[i], 0) << i;
  EXPECT_NEAR(tension_N[6], 1.0, step_N(profile, 6) / 2 * (1 + 1e-9));
}

TEST_F(SimulatedDeviceTest, HandThatIsNotFiniteIsIgnored) {
  SimulatedDevice device(profile, kFixedStep);
  device.open();
  Pose bad;
  bad.position_m.x() = std::nan("");
  device.set_hand(bad);
  bad = {};
  bad.orientation.coeffs().setZero();
  device.set_hand(bad);
  DeviceReading reading;
  device.exchange({}, reading);
  EXPECT_TRUE(device.felt().pose.position_m.isZero(0));

  Pose scaled;  // means the same turn
  scaled.orientation.coeffs() *= 5;
  device.set_hand(scaled);
  device.exchange({}, reading);
  EXPECT_TRUE(device.felt().angular_velocity_rad_s.isZero(0));
}

}  // namespace spidar::test::simulated_device_test
