// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// From a device through calibration and a profile file to the loop.
#include <unistd.h>

#include "spidar/calibration/samples.h"
#include "spidar/devices/sim/simulated_device.h"
#include "spidar/loop/haptic_loop.h"
#include "spidar/loop/string_grip.h"
#include "spidar/profiles/profile_file.h"
#include "tests/spidar/calibration_samples.h"
#include "tests/support/fake_device.h"
#include "tests/support/test.h"

namespace spidar::test::calibration_device_test {

namespace {

double largest_change_V(const std::vector<MotorVolts>& volts) {
  double largest = 0;
  for (size_t k = 1; k < volts.size(); ++k)
    for (size_t i = 0; i < kMaxStrings; ++i)
      largest = std::max(largest, std::abs(volts[k].volt[i] - volts[k - 1].volt[i]));
  return largest;
}

/// Volts of rest tension.
double rest_V(const Profile& profile) {
  return profile.drives[0].min_tension_N / profile.drives[0].newtons_per_volt;
}

}  // namespace

// Half a micrometre of offset is a twentieth of what rounding to 15 µm does to a pose (some 6 µm
// and 0.3 mrad): ten times that is allowed for the pose in the loop. Without the calibration the
// loop cannot find a pose at all.
TEST(CalibrationDevice, LoopFindsTheGripOfACalibratedDevice) {
  const Profile profile = load_profile("spidar-gcc");
  Random random(1);
  Profile real = profile;
  clear_counters_at(wrong_start(random, 0.04, 0.8), real);
  add_to_offsets(random, 3e-3, real);
  SimulatedDevice device(real, SimulatedDevice::Time::kFixedStep);
  const calibration::CountSamples counts =
      calibration::record_counts(device, profile, 10, 0.005, [&](double time_s) {
        device.set_hand(calibration::hand_in_motion(real.geometry, time_s));
        return true;
      });
  EXPECT_EQ(counts.rows(), 2000);
  const calibration::Result result = calibration::calibrate(profile, counts);
  ASSERT_EQ(result.status, calibration::Status::kSolved);

  const std::string path = (std::filesystem::temp_directory_path() /
                            ("spidar-calibrated-" + std::to_string(getpid()) + ".toml"))
                               .string();
  save_profile(calibration::calibrated_profile(profile, result, "a test"), path);
  const Profile calibrated = load_profile(path);
  std::filesystem::remove(path);
  for (const bool use_it : {true, false}) {
    HapticLoop loop(std::make_unique<StringGrip>(use_it ? calibrated : profile, device));
    loop.open();
    Pose hand;
    hand.position_m = {0.01, -0.015, 0.02};
    hand.orientation = Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 3).normalized());
    device.set_hand(hand);
    for (int64_t tick = 0; tick < 500; ++tick) loop.tick(tick * kTick_ns, tick * kTick_ns);
    const TickRecord last = loop.snapshot().last;
    const Pose grip = device.felt().pose;
    const double error_m = (last.pose.position_m - grip.position_m).norm();
    if (use_it) {
      EXPECT_LT(error_m, 6e-5);
      EXPECT_LT(last.pose.orientation.angularDistance(grip.orientation), 3e-3);
      EXPECT_EQ(loop.snapshot().counters.pose_errors, 0u);
    } else {
      EXPECT_GT(loop.snapshot().counters.pose_errors, 0u);
    }
  }
}

// 0.2 s from zero to rest tension, 0.05 s back: a millisecond changes it by a fiftieth at most.
TEST(CalibrationDevice, StringsAreEnergisedAndReleasedByRamps) {
  const Profile profile = load_profile("spidar-gcc");
  for (const bool stopped : {false, true}) {
    FakeDevice device;
    const calibration::CountSamples counts = calibration::record_counts(
        device, profile, 0.1, 0.001, [&](double time_s) { return !(stopped && time_s >= 0.05); });
    EXPECT_EQ(counts.rows(), stopped ? 50 : 100);
    EXPECT_EQ(counts.cols(), 8);
    const std::vector<MotorVolts>& volts = device.log().volts;
    EXPECT_LE(largest_change_V(volts), rest_V(profile) / 50 * (1 + 1e-9));
    EXPECT_NEAR(std::abs(volts[220].volt[0]), rest_V(profile), 1e-12);
    EXPECT_LE(std::abs(volts.front().volt[0]), rest_V(profile) / 200 * (1 + 1e-9));
    EXPECT_EQ(volts.back().volt[0], 0);
    EXPECT_EQ(device.log().closed, 1);
  }
}

TEST(CalibrationDevice, DeviceIsClosedWhateverHappens) {
  const Profile profile = load_profile("spidar-gcc");
  const auto never = [](double) { return true; };
  FakeDevice lost;
  lost.log().answer = LinkFault::kGone;
  EXPECT_THROW(calibration::record_counts(lost, profile, 1, 0.001, never), DeviceError);
  EXPECT_EQ(lost.log().closed, 1);

  FakeDevice silent;
  silent.log().answer = LinkFault::kTimeout;
  EXPECT_THROW(calibration::record_counts(silent, profile, 1, 0.001, never), DeviceError);
  EXPECT_EQ(silent.log().closed, 1);

  FakeDevice good;
  const auto throws = [](double time_s) -> bool {
    if (time_s > 0) throw std::runtime_error("stop");
    return true;
  };
  EXPECT_THROW(calibration::record_counts(good, profile, 1, 0.001, throws), std::runtime_error);
  EXPECT_EQ(good.log().closed, 1);
}

}  // namespace spidar::test::calibration_device_test
