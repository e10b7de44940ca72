// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// A hand that is led to a position, and what the grip of a simulated device makes of it.
#include "spidar/devices/sim/grip_model.h"
#include "tests/spidar/simulated_device_test.h"
#include "tests/support/test.h"

namespace spidar::test::guided_hand_test {
namespace {

constexpr double kTick_s = 1e-3;
/// Sums of hundreds of steps of numbers below 0.1.
constexpr double kRounding_m = 1e-14;

TEST(GuidedHand, GoesThereAndBackNoFasterThanAHand) {
  Pose rest;
  rest.position_m = {0, 0, 0.004};
  const Eigen::Vector3d there_m(0.03, -0.02, -0.006);
  GuidedHand hand;
  Eigen::Vector3d before_m = rest.position_m;
  const auto follow = [&](const std::optional<Eigen::Vector3d>& to_m) {
    const Eigen::Vector3d now_m = hand.advance(rest, to_m, kTick_s).position_m;
    EXPECT_LE((now_m - before_m).norm(), GuidedHand::kFastest_m_s * kTick_s + kRounding_m);
    before_m = now_m;
  };
  const double way_m = (there_m - rest.position_m).norm();
  const int ticks = static_cast<int>(way_m / (GuidedHand::kFastest_m_s * kTick_s));
  for (int tick = 0; tick < ticks; ++tick) follow(there_m);
  EXPECT_GT((before_m - there_m).norm(), kRounding_m) << "not before its time";
  follow(there_m);
  EXPECT_LE((before_m - there_m).norm(), kRounding_m);
  for (int tick = 0; tick < ticks; ++tick) follow({});
  EXPECT_GT((before_m - rest.position_m).norm(), kRounding_m);
  follow({});
  EXPECT_LE((before_m - rest.position_m).norm(), kRounding_m);
  rest.position_m = {0.01, 0, 0};
  EXPECT_EQ(hand.advance(rest, {}, kTick_s).position_m, rest.position_m) << "at rest as before";
}

TEST_F(SimulatedDeviceTest, AHandIsLedToTheFrameAtMostAndNowhereWithoutAPlace) {
  SimulatedDevice device(profile, kFixedStep);
  device.open();
  DeviceReading reading;
  const double none = std::numeric_limits<double>::quiet_NaN();
  device.lead_hand(Eigen::Vector3d(none, 0, 0));
  for (int tick = 0; tick < 100; ++tick) device.exchange({}, reading);
  EXPECT_TRUE(device.felt().pose.position_m.isZero(0));
  device.lead_hand(Eigen::Vector3d(1e9, 0, 0));
  for (int tick = 0; tick < 2000; ++tick) device.exchange({}, reading);
  const GripDynamics dynamics(profile.geometry, profile.max_tension_N(), {});
  EXPECT_NEAR(device.felt().pose.position_m.x(), dynamics.limit_m().x(), 1e-9);
  device.lead_hand(std::nullopt);
  for (int tick = 0; tick < 2000; ++tick) device.exchange({}, reading);
  EXPECT_LT(device.felt().pose.position_m.norm(), 1e-9) << "not stored beyond it";
}

TEST_F(SimulatedDeviceTest, AHandMayBeLedByAnotherThread) {
  SimulatedDevice device(profile, kFixedStep);
  device.open();
  std::thread leader([&] {
    for (int n = 0; n < 20'000; ++n) {
      // x and y of one position belong together, which a torn read would show.
      const double at_m = n % 2 == 0 ? 0.02 : -0.02;
      device.lead_hand(Eigen::Vector3d(at_m, at_m, 0));
    }
  });
  DeviceReading reading;
  for (int tick = 0; tick < 2000; ++tick) {
    device.exchange({}, reading);
    const Eigen::Vector3d at_m = device.felt().pose.position_m;
    ASSERT_LE(std::abs(at_m.x() - at_m.y()), 1e-9) << tick;
  }
  leader.join();
}

}  // namespace
}  // namespace spidar::test::guided_hand_test
