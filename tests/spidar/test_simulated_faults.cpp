// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The simulated device when the host is silent, when faults are injected, when it is closed, and
// when several threads read it.

#include "tests/spidar/simulated_device_test.h"
#include "tests/support/test.h"

namespace spidar::test::simulated_faults_test {

TEST_F(SimulatedDeviceTest, SilentHostLeavesTheStringsPulling) {
  SimulatedDevice device(profile, kFixedStep);
  device.open();
  DeviceReading reading;
  for (int tick = 0; tick < 100; ++tick)
    device.exchange(volts_for(profile, StringVector::Constant(2.0)), reading);
  const FeltState before = device.felt();
  EXPECT_NEAR(before.tension_N[0], 2.0, step_N(profile, 0) / 2 * (1 + 1e-9));

  // Nothing arrives for half a second: the last volts stand.
  device.set_fault(LinkFault::kTimeout);
  for (int tick = 0; tick < 500; ++tick)
    ASSERT_EQ(device.exchange({}, reading), LinkFault::kTimeout);
  const FeltState after = device.felt();
  EXPECT_EQ(after.time_ns - before.time_ns, 500'000'000);
  EXPECT_NEAR(after.tension_N[0], before.tension_N[0], 1e-12);
}

TEST_F(SimulatedDeviceTest, FaultsAnswerAsToldUntilTheyEnd) {
  SimulatedDevice device(profile, kFixedStep, without_lag());
  device.open();
  const MotorVolts volts = volts_for(profile, StringVector::Constant(1.0));
  DeviceReading reading;

  device.set_fault(LinkFault::kWrongReply);
  reading.count.fill(77);
  for (int tick = 0; tick < 2; ++tick)
    EXPECT_EQ(device.exchange(volts, reading), LinkFault::kWrongReply);
  EXPECT_EQ(reading.count[0], 77) << "written although the reply was bad";
  EXPECT_GT(device.felt().tension_N[0], 0.9) << "the volts arrive, only the reply is bad";

  device.set_fault(LinkFault::kNone);
  EXPECT_EQ(device.exchange(volts, reading), LinkFault::kNone);
  EXPECT_NE(reading.count[0], 77);

  device.set_fault(LinkFault::kGone);
  EXPECT_EQ(device.exchange(volts, reading), LinkFault::kGone);
  EXPECT_TRUE(device.felt().tension_N.isZero(0));
  EXPECT_THROW(device.open(), DeviceError);
  device.close();

  device.set_fault(LinkFault::kNone);
  EXPECT_EQ(device.exchange(volts, reading), LinkFault::kGone) << "lost until opened again";
  device.open();
  EXPECT_EQ(device.felt().time_ns, 0);
  EXPECT_EQ(device.exchange(volts, reading), LinkFault::kNone);
}

TEST_F(SimulatedDeviceTest, ClosingRelaxesTheMotorsAndEverythingFeltIsKept) {
  SimulatedDevice device(profile, kFixedStep);
  FeltState felt;
  EXPECT_FALSE(device.pop_felt(felt));
  device.close();
  EXPECT_FALSE(device.pop_felt(felt)) << "closing what is not open does nothing";
  device.open();
  DeviceReading reading;
  for (int tick = 0; tick < 50; ++tick)
    device.exchange(volts_for(profile, StringVector::Constant(2.0)), reading);
  device.close();
  device.close();
  EXPECT_TRUE(device.felt().tension_N.isZero(0));
  EXPECT_EQ(device.exchange({}, reading), LinkFault::kGone);

  // Tensions rise while it is open, then fall without a step down: a lag of 2 ms keeps e^(−1/2) =
  // 61 % from one millisecond to the next, until next to nothing is left.
  int64_t ticks = -1;
  double last_N = 0;
  while (device.pop_felt(felt)) {
    ++ticks;
    if (ticks > 50 && last_N > 1e-3) {
      EXPECT_NEAR(felt.tension_N[0], last_N * std::exp(-0.5), 1e-12) << ticks;
    }
    last_N = felt.tension_N[0];
  }
  EXPECT_GE(ticks, 50 + 10);
  EXPECT_EQ(last_N, 0);
}

// States read from another thread while the hand is moved from a third are whole: the wrench that
// was stored with a pose and tensions is the one these give.
TEST_F(SimulatedDeviceTest, OtherThreadsSeeWholeStates) {
  SimulatedDevice device(profile, kFixedStep);
  device.open();
  std::atomic<bool> done{false};
  std::atomic<int> torn{0};
  std::thread reader([&] {
    while (!done) {
      const FeltState felt = device.felt();
      const Eigen::Matrix<double, 6, 1> wrench =
          structure_matrix(profile.geometry, felt.pose) * felt.tension_N;
      if (!(felt.wrench.stacked() - wrench).isZero(1e-12)) ++torn;
    }
  });
  std::thread hand([&] {
    std::mt19937 random(3);
    while (!done) device.set_hand(hand_at(random));
  });
  std::mt19937 random(4);
  std::uniform_real_distribution<double> tension(0, 4);
  DeviceReading reading;
  for (int tick = 0; tick < 3000; ++tick) {
    StringVector tension_N;
    for (double& t : tension_N) t = tension(random);
    device.exchange(volts_for(profile, tension_N), reading);
  }
  done = true;
  reader.join();
  hand.join();
  EXPECT_EQ(torn, 0);
}

TEST_F(SimulatedDeviceTest, ClockModeTakesTheTimeThatPassedUpToFiftyMilliseconds) {
  SimulatedDevice device(profile, SimulatedDevice::Time::kClock);
  const auto start = std::chrono::steady_clock::now();
  device.open();
  DeviceReading reading;
  for (int tick = 0; tick < 20; ++tick) device.exchange({}, reading);
  const auto passed = std::chrono::steady_clock::now() - start;
  const int64_t before_ns = device.felt().time_ns;
  EXPECT_GE(before_ns, 0);
  EXPECT_LE(before_ns, std::chrono::nanoseconds(passed).count());

  // sleep_for() never returns early.
  std::this_thread::sleep_for(std::chrono::milliseconds(60));
  device.exchange({}, reading);
  EXPECT_EQ(device.felt().time_ns - before_ns, 50'000'000);
}

}  // namespace spidar::test::simulated_faults_test
