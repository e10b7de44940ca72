// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The loop and its device: opening, closing, losing it, and the pose of the grip.
#include <Eigen/LU>

#include "spidar/devices/sim/simulated_device.h"
#include "spidar/loop/string_grip.h"
#include "tests/spidar/loop_driver.h"
#include "tests/support/test.h"

namespace spidar::test::haptic_loop_device_test {
namespace {

double largest_volt(const MotorVolts& volts) {
  double largest = 0;
  for (const double volt : volts.volt) largest = std::max(largest, std::abs(volt));
  return largest;
}

/// Largest change of a volt between two exchanges, from `first` on.
double largest_step_V(const std::vector<MotorVolts>& volts, size_t first = 1) {
  double largest = 0;
  for (size_t i = std::max<size_t>(first, 1); i < volts.size(); ++i) {
    for (size_t k = 0; k < kMaxStrings; ++k) {
      largest = std::max(largest, std::abs(volts[i].volt[k] - volts[i - 1].volt[k]));
    }
  }
  return largest;
}

/// Pushes to the right with 1 N until the end of the world.
void push(LoopDriver& driver) {
  driver.loop->schedule({0, INT64_MAX / 2, push_right(1)});
  driver.play(0);
}

TEST(HapticLoopDevice, OpenFailsWithoutDevice) {
  LoopDriver driver;
  driver.log().present = false;
  EXPECT_THROW(driver.loop->open(), DeviceError);
  EXPECT_EQ(driver.tick().device, DeviceState::kClosed);
  EXPECT_TRUE(driver.log().volts.empty());
}

TEST(HapticLoopDevice, OpeningEnergisesSlowly) {
  LoopDriver driver;
  driver.loop->open();
  EXPECT_EQ(driver.tick().device, DeviceState::kOpening);
  const TickRecord record = driver.run(300 * kMs);
  EXPECT_EQ(record.device, DeviceState::kRunning);
  // At rest the solver's optimum is t_ref when it balances the grip; in any case within bounds.
  for (int i = 0; i < driver.profile.geometry.count; ++i) {
    EXPECT_GE(record.tension_N[i], driver.profile.min_tension_N()[i]);
  }
  // No step: the n-th of 200 ticks has n / 200 of the tension.
  const double rest_V = largest_volt(driver.log().last_volts);
  EXPECT_GT(rest_V, 0);
  EXPECT_LE(largest_volt(driver.log().volts.front()), rest_V / 200 * 1.001);
  EXPECT_LE(largest_step_V(driver.log().volts), rest_V / 200 * 1.001);
}

TEST(HapticLoopDevice, ClosesAtZeroVoltsWithinATenthOfASecond) {
  LoopDriver driver;
  driver.open();
  push(driver);
  ASSERT_EQ(driver.run(100 * kMs).commanded.force_N.x(), 1);
  const double before_V = largest_volt(driver.log().last_volts);
  const size_t first = driver.log().volts.size();
  EXPECT_FALSE(driver.loop->released());
  driver.loop->begin_close();
  const int64_t begin = driver.now_ns;
  while (!driver.loop->released()) {
    driver.tick();
    ASSERT_LT(driver.now_ns, begin + 100 * kMs);
  }
  EXPECT_EQ(driver.loop->snapshot().last.device, DeviceState::kClosing);
  EXPECT_EQ(driver.loop->snapshot().last.commanded.stacked().norm(), 0);
  EXPECT_EQ(largest_volt(driver.log().last_volts), 0);
  // A product of two linear ramps (the wrench's in 40 ms, the power's in 50 ms) never falls faster
  // than the sum of their rates.
  EXPECT_LE(largest_step_V(driver.log().volts, first), before_V * (1.0 / 40 + 1.0 / 50));
  EXPECT_TRUE(driver.log().is_open);
  driver.loop->close();
  EXPECT_FALSE(driver.log().is_open);
  EXPECT_EQ(driver.loop->snapshot().last.device, DeviceState::kClosed);
  // Opened again it runs again.
  driver.open();
  EXPECT_EQ(driver.tick().device, DeviceState::kRunning);
}

TEST(HapticLoopDevice, DestructorClosesDevice) {
  LoopDriver driver;
  driver.open();
  driver.loop.reset();
  EXPECT_FALSE(driver.log().is_open);
}

TEST(HapticLoopDevice, LostAndBack) {
  LoopDriver driver;
  driver.open();
  push(driver);
  driver.run(100 * kMs);
  driver.log().present = false;
  driver.log().answer = LinkFault::kGone;
  EXPECT_EQ(driver.tick().device, DeviceState::kLost);
  EXPECT_TRUE(driver.loop->lost());
  const size_t exchanges = driver.log().volts.size();
  const TickRecord lost = driver.run(100 * kMs);
  EXPECT_EQ(lost.commanded.stacked().norm(), 0);
  EXPECT_EQ(lost.tension_N.norm(), 0);
  EXPECT_EQ(lost.wanted.force_N.x(), 1);  // the timeline is kept
  EXPECT_EQ(driver.log().volts.size(), exchanges);
  EXPECT_FALSE(driver.loop->reopen());
  EXPECT_TRUE(driver.loop->lost());

  driver.log().present = true;
  driver.log().answer = LinkFault::kNone;
  EXPECT_TRUE(driver.loop->reopen());
  // Power and wrench begin at zero again.
  EXPECT_LT(driver.tick(300 * kMs).commanded.force_N.norm(), 0.05);
  EXPECT_LT(largest_volt(driver.log().last_volts), 0.05);
  EXPECT_EQ(driver.loop->snapshot().last.device, DeviceState::kOpening);
  EXPECT_EQ(driver.run(300 * kMs).commanded.force_N.x(), 1);
  EXPECT_EQ(driver.counters().times_lost, 1u);
  EXPECT_EQ(driver.counters().missed_deadlines, 0u);  // the wait does not count
}

TEST(HapticLoopDevice, ErrorsInARowOrInMostTicksAreALoss) {
  for (const LinkFault error : {LinkFault::kTimeout, LinkFault::kWrongReply}) {
    LoopDriver driver;
    driver.open();
    for (int round = 0; round < 3; ++round) {
      for (const LinkFault answer : {error, LinkFault::kNone}) {
        driver.log().answer = answer;
        for (int i = 0; i < HapticLoop::kMaxErrors - 1; ++i) driver.tick();
      }
      EXPECT_FALSE(driver.loop->lost());
    }
    driver.log().answer = error;
    for (int i = 0; i < HapticLoop::kMaxErrors; ++i) driver.tick();
    EXPECT_TRUE(driver.loop->lost());
    EXPECT_EQ(driver.counters().exchange_errors,
              3u * (HapticLoop::kMaxErrors - 1) + HapticLoop::kMaxErrors);
    ASSERT_TRUE(driver.loop->reopen());
    // Three of four, which is one more than half of them in two ticks.
    for (int i = 0; i < 2 * HapticLoop::kMaxErrors; ++i) {
      driver.log().answer = i % 4 == 0 ? LinkFault::kNone : error;
      driver.tick();
    }
    EXPECT_TRUE(driver.loop->lost());
  }
}

TEST(HapticLoopDevice, ReportsAFaultyString) {
  LoopDriver driver;
  driver.open();
  Pose pose;
  pose.position_m = {2e-4, -1e-4, 1e-4};
  put_grip(driver, pose);
  TickRecord record = driver.tick();
  EXPECT_EQ(record.faulty_string, -1);
  driver.log().count[6] += 65;  // 1 mm in a tick, which no hand explains: left out once
  EXPECT_EQ(driver.tick().faulty_string, -1);
  record = driver.tick();
  EXPECT_EQ(record.faulty_string, 6);
  EXPECT_EQ(driver.counters().string_faults, 1u);
  // Seven strings at a count of 15 µm each, with some conditioning.
  EXPECT_LE((record.pose.position_m - pose.position_m).norm(), 1e-4);
  EXPECT_EQ(driver.tick().faulty_string, 6);
  EXPECT_EQ(driver.counters().string_faults, 1u) << "counted once";
  EXPECT_EQ(driver.counters().pose_errors, 1u) << "the reading that was left out";
}

TEST(HapticLoopDevice, KnowsWhereTheGripIs) {
  const Profile profile = load_profile(kDefaultProfile);
  SimulatedDevice device(profile, SimulatedDevice::Time::kFixedStep);
  const auto loop = std::make_unique<HapticLoop>(std::make_unique<StringGrip>(profile, device));
  loop->open();
  Pose hand;
  hand.position_m = {0.012, -0.007, 0.004};
  hand.orientation = Eigen::AngleAxisd(0.2, Eigen::Vector3d(1, 2, 2) / 3);
  device.set_hand(hand);
  int64_t now = 0;
  TickRecord before;
  for (int i = 0; i < 1000; ++i) {
    before = loop->snapshot().last;
    now += kTick_ns;
    loop->tick(now, now);
  }
  const TickRecord record = loop->snapshot().last;
  EXPECT_EQ(record.device, DeviceState::kRunning);
  EXPECT_EQ(loop->snapshot().counters.pose_errors, 0u);
  // What the strings do there, with W of the reading before this tick's.
  const StructureMatrix used = structure_matrix(profile.geometry, before.pose);
  EXPECT_LE((used * record.tension_N - record.delivered.stacked()).norm(), 1e-12);
  EXPECT_GT(record.pose.position_m.norm(), 0.005);
  // Each length is read within half a count. The pose is their least-squares fit, so its error is
  // at most |pinv(Wᵀ)| times that of the lengths (rows of Wᵀ are the derivatives of the lengths).
  const FeltState felt = device.felt();
  const StructureMatrix W = structure_matrix(profile.geometry, felt.pose);
  const StructureMatrix inverse = (W * W.transpose()).inverse() * W;
  const double half_count_m = 0.5 * profile.drives[0].metres_per_count;
  const double error = half_count_m * std::sqrt(profile.geometry.count);
  EXPECT_LE((record.pose.position_m - felt.pose.position_m).norm(),
            1.1 * error * inverse.topRows<3>().norm());
  EXPECT_LE(record.pose.orientation.angularDistance(felt.pose.orientation),
            1.1 * error * inverse.bottomRows<3>().norm());
}

}  // namespace
}  // namespace spidar::test::haptic_loop_device_test
