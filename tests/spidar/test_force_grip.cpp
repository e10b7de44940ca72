// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Devices that take a force: every kind with its emulation, without a wire, and the grip on them.
#include "core/grip/string_geometry.h"
#include "spidar/chain/brake_table.h"
#include "spidar/session/haptic_session.h"
#include "tests/spidar/device_test.h"
#include "tests/spidar/force_bench.h"
#include "tests/support/felt_player.h"
#include "tests/support/test.h"

namespace spidar::test::force_grip_test {
namespace {

class ForceBoards : public testing::TestWithParam<std::string>, public ForceBench {
 protected:
  ForceBoards() : ForceBench(GetParam()) {}

  /// Until every axis could be set; returns the worst status.
  LinkFault exchange(boards::ForceLink& device, const boards::ForceOutput& output, int times = 2) {
    LinkFault worst = LinkFault::kNone;
    for (int i = 0; i < times * cycles(); ++i) {
      const LinkFault status = device.exchange(output, reading);
      if (status != LinkFault::kNone) worst = status;
    }
    return worst;
  }

  boards::ForceReading reading;
};
INSTANTIATE_TEST_SUITE_P(, ForceBoards, testing::ValuesIn(boards_that_there_are(false)), name_of);

TEST_P(ForceBoards, OpenLeavesThemAtRest) {
  const auto device = linked();
  device->open();
  for (const int digit : motors.history) EXPECT_EQ(digit, 0);
}

TEST_P(ForceBoards, ForcesThatAreNoNumbersPushNowhere) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const auto device = linked();
  device->open();
  for (const double value : {kNan, kInfinity, -kInfinity}) {
    ASSERT_EQ(exchange(*device, pushing(1, 1)), LinkFault::kNone);
    ASSERT_FALSE(motors.all_zero());
    ASSERT_EQ(exchange(*device, pushing(value, value)), LinkFault::kNone);
    EXPECT_TRUE(motors.all_zero()) << value;
  }
}

TEST_P(ForceBoards, CloseEndsAtRest) {
  for (const bool threaded : {false, true}) {
    const auto device = linked(threaded);
    device->open();
    exchange(*device, pushing(1));
    if (!threaded) {
      ASSERT_FALSE(motors.all_zero());
    }
    const size_t before = motors.history.size();
    device->close();
    if (!threaded) {
      EXPECT_GT(motors.history.size(), before);
    }
    EXPECT_TRUE(motors.all_zero());
    const int updates = motors.updates;
    device->close();
    EXPECT_EQ(motors.updates, updates);
    EXPECT_EQ(device->exchange(pushing(1), reading), LinkFault::kGone);
  }
}

/// A force that lasts is no sign of a dead sensor: a stick may be held still, and the mouse has no
/// sensor.
TEST_P(ForceBoards, TheHapticLoopDrivesThemAndTheForceLasts) {
  HapticSession session(grip(), by_hand());
  int64_t now_ns = 0;
  session.loop().set_playback_clock({now_ns, 0, 1.0, true});
  ASSERT_TRUE(session.loop().schedule(lasting({1, 0.5, 0})));
  while (now_ns < 3 * kSecond_ns) {
    now_ns += kTick_ns;
    session.loop().tick(now_ns, now_ns);
  }
  const LoopSnapshot now = session.loop().snapshot();
  EXPECT_EQ(now.counters.exchange_errors, 0u);
  EXPECT_EQ(now.last.device, DeviceState::kRunning);
  EXPECT_EQ(now.last.commanded.force_N, Eigen::Vector3d(1, 0.5, 0));
  EXPECT_EQ(now.last.delivered.force_N, Eigen::Vector3d(1, 0.5, 0));
  EXPECT_EQ(now.last.pose_fault, PoseFault::kNone);
  EXPECT_NEAR(motors.digit[0] / 2, motors.digit[1], rounding());
  EXPECT_GT(motors.digit[1], 0);
}

TEST(ForceGrip, GivesNeitherTorqueNorWhatTheDeviceCannotGive) {
  ForceBench bench("mouse");
  const auto grip = bench.grip();
  grip->open();
  GripCommand command = told(3, 4);
  command.wrench.force_N.z() = 2;
  command.wrench.torque_Nm = {0.1, 0.1, 0.1};
  for (int i = 0; i < bench.cycles(); ++i) ASSERT_EQ(grip->exchange(command), LinkFault::kNone);
  const Wrench delivered = grip->reading().delivered;
  EXPECT_TRUE(delivered.force_N.isApprox(Eigen::Vector3d(0.9, 1.2, 0), 1e-12));
  EXPECT_TRUE(delivered.torque_Nm.isZero(0));
  EXPECT_EQ(bench.motors.digit[0], 900);
  EXPECT_EQ(bench.motors.digit[1], 1200);
  command.power = 0.5;
  ASSERT_EQ(grip->exchange(command), LinkFault::kNone);
  EXPECT_TRUE(grip->reading().delivered.force_N.isApprox(Eigen::Vector3d(0.9, 1.2, 0), 1e-12))
      << "half of 5 N is still too much";
  command.power = 0.1;
  ASSERT_EQ(grip->exchange(command), LinkFault::kNone);
  EXPECT_TRUE(grip->reading().delivered.force_N.isApprox(Eigen::Vector3d(0.3, 0.4, 0), 1e-12));
}

/// A grip that is driven tick by tick.
struct Driven {
  explicit Driven(const std::string& board) : bench(board) { grip->open(); }
  void exchange(int times) {
    for (int i = 0; i < times; ++i) {
      command.now_ns += kTick_ns;
      grip->check_age(command.now_ns);
      grip->exchange(command);
    }
  }

  ForceBench bench;
  const std::unique_ptr<boards::ForceGrip> grip = bench.grip();
  GripCommand command = told(1);
};

/// See Grip::exchange().
TEST(ForceGrip, ThePoseBecomesKnownOnlyWithoutAForceAndIsLostWithTheAnswers) {
  Driven stick("ff");
  stick.exchange(2 * PoseTrust::kGoodPoses);
  EXPECT_FALSE(stick.grip->reading().knows_pose());
  stick.command.wrench = {};
  stick.exchange(1);
  EXPECT_TRUE(stick.grip->reading().knows_pose());
  stick.command.wrench.force_N.x() = 1;
  stick.exchange(10);
  EXPECT_TRUE(stick.grip->reading().knows_pose());
  *stick.bench.wire = LinkFault::kGone;
  // Single failed updates are no loss.
  stick.exchange(static_cast<int>(boards::UpdateWatch::kFailures) *
                     boards::ForceFeedback::kUpdate_ms +
                 PoseTrust::kMaxMisses);
  EXPECT_FALSE(stick.grip->reading().knows_pose());
  EXPECT_EQ(stick.grip->reading().delivered.force_N.x(), 1) << "the last that was acknowledged";
}

/// In every fifth answer: the position is 40 mm off, 1 mm, or one that no device has.
TEST(ForceGrip, ABitThatFlipsIsNoMotion) {
  Driven device("inverse3");
  device.command.wrench = {};
  device.exchange(PoseTrust::kGoodPoses);
  for (const int off_um : {40'000, 1'000, -200'000}) {
    for (int n = 0; n < 10; ++n) {
      device.bench.motors.count[1] = off_um;
      device.exchange(1);
      device.bench.motors.count[1] = 0;
      device.exchange(4);
      ASSERT_TRUE(device.grip->reading().knows_pose()) << off_um;
      ASSERT_TRUE(device.grip->reading().motion.velocity().linear_m_s.isZero(0)) << off_um;
    }
  }
}

/// A device, or its service, that measures from another origin from now on.
TEST(ForceGrip, AJumpIsNotFollowedUntilItHasLasted) {
  Driven device("inverse3");
  device.command.wrench = {};
  device.exchange(PoseTrust::kGoodPoses);
  ASSERT_TRUE(device.grip->reading().knows_pose());
  device.bench.motors.count[0] = 200'000;  // µm
  device.exchange(1);
  EXPECT_TRUE(device.grip->reading().pose.position_m.isZero(0)) << "a bit may have flipped";
  device.exchange(1);
  EXPECT_EQ(device.grip->reading().pose_fault, PoseFault::kJump);
  device.exchange(PoseTrust::kGoodPoses - 1);
  EXPECT_FALSE(device.grip->reading().knows_pose());
  device.exchange(1);
  EXPECT_TRUE(device.grip->reading().knows_pose());
  EXPECT_NEAR(device.grip->reading().pose.position_m.x(), 0.2, 1e-9);
  EXPECT_TRUE(device.grip->reading().motion.velocity().linear_m_s.isZero(0));
}

TEST(ForceGrip, AStickMaySnapBack) {
  Driven stick("ff");
  stick.command.wrench = {};
  stick.exchange(PoseTrust::kGoodPoses);
  stick.bench.motors.count[0] = ff::Position::kFull;
  stick.exchange(boards::ForceFeedback::kUpdate_ms);
  EXPECT_TRUE(stick.grip->reading().knows_pose());
  EXPECT_GT(stick.grip->reading().pose.position_m.x(), 0.01);
}

/// A stick that swings back when a hand lets go is no danger: it stays on its base.
TEST(ForceGrip, AStickThatSwingsKeepsItsForce) {
  ForceBench stick("ff");
  HapticLoop loop(stick.grip());
  loop.open();
  int64_t now_ns = 0;
  loop.set_playback_clock({now_ns, 0, 1.0, true});
  ASSERT_TRUE(loop.schedule(lasting({1, 0.5, 0})));
  double fastest_m_s = 0;
  for (int ms = 0; ms < 1000; ++ms) {
    if (ms > 500) stick.motors.count[0] = (ms / 20 % 2 == 0 ? 1 : -1) * ff::Position::kFull;
    loop.tick(now_ns, now_ns);
    now_ns += kTick_ns;
    const TickRecord now = loop.snapshot().last;
    fastest_m_s = std::max(fastest_m_s, now.velocity.linear_m_s.norm());
    ASSERT_TRUE(now.held) << ms;
    if (ms <= 300) continue;
    ASSERT_EQ(now.commanded.force_N, Eigen::Vector3d(1, 0.5, 0)) << ms;
  }
  EXPECT_GT(fastest_m_s, brake::kFadeFrom_m_s);
}

}  // namespace
}  // namespace spidar::test::force_grip_test
