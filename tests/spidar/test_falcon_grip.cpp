// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The grip of a Novint Falcon: its arms, its room, and its zero.
#include "spidar/session/haptic_session.h"
#include "tests/spidar/device_test.h"
#include "tests/spidar/force_bench.h"
#include "tests/support/felt_player.h"
#include "tests/support/test.h"

namespace spidar::test::falcon_grip_test {
namespace {

TEST(FalconGrip, TakesForcesAndGivesPositionsInAllAxes) {
  ForceBench bench("falcon");
  const auto grip = bench.grip();
  grip->open();
  EXPECT_EQ(grip->description(), "Novint Falcon");
  GripCommand command = told(1, 2);
  command.wrench.force_N.z() = -3;
  for (const Eigen::Vector3d& at_mm :
       {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(30, -20, 10), Eigen::Vector3d(-25, 30, -30)}) {
    for (size_t axis = 0; axis < 3; ++axis)
      bench.motors.count[axis] = static_cast<int>(1000 * at_mm[static_cast<Eigen::Index>(axis)]);
    // The force is that for the position of the answer before.
    for (int i = 0; i < 2; ++i) ASSERT_EQ(grip->exchange(command), LinkFault::kNone);
    // Half a count of each encoder is 0.018 degrees, at some 60 mm/rad.
    EXPECT_LT((1000 * grip->reading().pose.position_m - at_mm).norm(), 0.05) << at_mm.transpose();
    for (size_t axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(bench.motors.digit[axis],
                  1000 * command.wrench.force_N[static_cast<Eigen::Index>(axis)],
                  2 * bench.rounding())
          << at_mm.transpose();
  }
}

/// Every position of the 50 mm around the centre, in every direction.
TEST(FalconGrip, GivesItsLargestForceEverywhere) {
  ForceBench bench("falcon");
  const auto grip = bench.grip();
  grip->open();
  const double most_N = grip->abilities().largest_force_N;
  for (int i = 0; i < 2000; ++i) {
    const double turn = 2.4 * i, up = 1 - (i % 41) / 20.0, side = std::sqrt(1 - up * up);
    const Eigen::Vector3d at_mm =
        50 * Eigen::Vector3d(side * std::cos(turn), side * std::sin(turn), up);
    for (size_t axis = 0; axis < 3; ++axis)
      bench.motors.count[axis] = static_cast<int>(1000 * at_mm[static_cast<Eigen::Index>(axis)]);
    const double way = 0.37 * i, out = 1 - (i % 53) / 26.0, across = std::sqrt(1 - out * out);
    GripCommand command = told(1);
    command.wrench.force_N =
        2 * most_N * Eigen::Vector3d(across * std::cos(way), out, across * std::sin(way));
    for (int again = 0; again < 2; ++again) ASSERT_EQ(grip->exchange(command), LinkFault::kNone);
    const Eigen::Vector3d delivered =
        1e-3 * Eigen::Vector3d(bench.motors.digit[0], bench.motors.digit[1], bench.motors.digit[2]);
    ASSERT_LT((delivered - command.wrench.force_N / 2).norm(), 6e-3 * bench.rounding())
        << at_mm.transpose();
  }
}

TEST(FalconGrip, ReachesTheWholeRoomThatItStates) {
  ForceBench bench("falcon");
  const auto grip = bench.grip();
  const std::array<double, 3> half_m = grip->abilities().half_workspace_m;
  grip->open();
  for (int corner = 0; corner < 8; ++corner) {
    Eigen::Vector3d at_m;
    for (int axis = 0; axis < 3; ++axis) {
      at_m[axis] = (corner >> axis & 1 ? 1 : -1) * half_m[static_cast<size_t>(axis)];
      bench.motors.count[static_cast<size_t>(axis)] = static_cast<int>(1e6 * at_m[axis]);
    }
    ASSERT_EQ(grip->exchange(told(0)), LinkFault::kNone);
    // Half a count of each encoder, at some 80 mm/rad here.
    EXPECT_LT((grip->reading().pose.position_m - at_m).norm(), 6e-5) << at_m.transpose();
  }
}

/// 0.1 kg that nobody holds, from one side of the workspace to the other. 3 N alone would make it
/// 2.4 m/s fast.
TEST(FalconGrip, ReleasedItStaysSlow) {
  ForceBench bench("falcon");
  HapticSession session(bench.grip(), by_hand());
  int64_t now_ns = 0;
  session.loop().set_playback_clock({now_ns, 0, 1.0, true});
  double at_m = -0.05, speed_m_s = 0, fastest_m_s = 0;
  bench.motors.count[0] = -50'000;
  const auto tick = [&] {
    now_ns += kTick_ns;
    session.loop().tick(now_ns, now_ns);
  };
  while (now_ns < kSecond_ns) tick();
  ASSERT_TRUE(session.loop().schedule(lasting({3, 0, 0})));
  for (; at_m < 0.05 && now_ns < 3 * kSecond_ns; tick()) {
    speed_m_s += kTick_s * 1e-3 * bench.motors.digit[0] / 0.1;
    at_m += kTick_s * speed_m_s;
    bench.motors.count[0] = static_cast<int>(std::lround(1e6 * at_m));
    fastest_m_s = std::max(fastest_m_s, speed_m_s);
  }
  EXPECT_GT(fastest_m_s, 0.3) << "is not pushed";
  EXPECT_LT(fastest_m_s, 1.2);
}

TEST(FalconGrip, WithoutItsZeroHasNoPositionAndNoForce) {
  ForceBench bench("falcon");
  bench.motors.inputs = 0x35;  // two encoders; buttons 1 and 3
  const auto grip = bench.grip();
  grip->open();
  expect_contains(grip->description(), "push it all the way in");
  for (int i = 0; i < 2 * PoseTrust::kGoodPoses; ++i)
    ASSERT_EQ(grip->exchange(told(2)), LinkFault::kNone);
  EXPECT_TRUE(bench.motors.all_zero());
  EXPECT_EQ(grip->reading().pose_fault, PoseFault::kNotHomed);
  EXPECT_EQ(grip->reading().buttons, 5u);
  bench.motors.inputs = 0x70;
  for (int i = 0; i < 2 * PoseTrust::kGoodPoses; ++i)
    ASSERT_EQ(grip->exchange(told(0)), LinkFault::kNone);
  EXPECT_TRUE(grip->reading().knows_pose());
  ASSERT_EQ(grip->exchange(told(2)), LinkFault::kNone);
  EXPECT_NEAR(bench.motors.digit[0], 2000, bench.rounding());
}

}  // namespace
}  // namespace spidar::test::falcon_grip_test
