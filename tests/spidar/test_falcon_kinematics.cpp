// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The arms of the Novint Falcon, against the lengths of their parts over the whole workspace.
#include "spidar/devices/falcon/kinematics.h"
#include "tests/support/test.h"

namespace spidar::test::falcon_kinematics_test {
namespace {

using Eigen::Vector3d;

constexpr double kDegree_rad = M_PI / 180;
/// Positions and lengths of some 0.1 m are computed in some ten steps, each rounded by 1e-17 m.
constexpr double kRounding_m = 1e-14;

/// A grid of 5 mm within the reach.
std::vector<Vector3d> workspace() {
  std::vector<Vector3d> positions;
  constexpr int kSteps = 11;
  for (int x = -kSteps; x <= kSteps; ++x)
    for (int y = -kSteps; y <= kSteps; ++y)
      for (int z = -kSteps; z <= kSteps; ++z)
        if (const Vector3d at = 0.005 * Vector3d(x, y, z); at.norm() <= falcon::kReach_m)
          positions.push_back(at);
  return positions;
}

/// Length of the rods of the arm at this angle of the base, if the upper arm has this angle.
double rods_m(double arm_rad, double angle_rad, const Vector3d& position_m) {
  const double c = std::cos(arm_rad), s = std::sin(arm_rad);
  const Vector3d out(c, s, 0), aside(-s, c, 0), forward(0, 0, 1);
  const Vector3d knee = 0.040 * out - 0.02309 * aside +
                        0.060 * (std::cos(angle_rad) * out + std::sin(angle_rad) * forward);
  const Vector3d end = position_m + 0.125 * forward + 0.01443 * out - 0.025 * aside;
  const Vector3d between = end - knee;
  const Vector3d in_plane = between - between.dot(aside) * aside;
  return (between - 0.0225 * in_plane.normalized()).norm();
}

TEST(FalconKinematics, TheRodsHaveTheirLength) {
  for (const Vector3d& at : workspace()) {
    const auto angles = falcon::arm_angles(at);
    ASSERT_TRUE(angles) << at.transpose();
    // The first arm is 15 degrees left of the top; the others follow clockwise, seen by the user.
    for (int arm = 0; arm < 3; ++arm)
      ASSERT_NEAR(rods_m((105 - 120 * arm) * kDegree_rad, (*angles)[arm], at), 0.1025, kRounding_m)
          << at.transpose();
  }
}

TEST(FalconKinematics, AnglesAndPlacesBelongTogether) {
  double worst_m = 0;
  for (const Vector3d& at : workspace()) {
    const auto angles = falcon::arm_angles(at);
    ASSERT_TRUE(angles) << at.transpose();
    const auto found = falcon::grip_position(*angles);
    ASSERT_TRUE(found) << at.transpose();
    worst_m = std::max(worst_m, (*found - at).norm());
  }
  EXPECT_LE(worst_m, 10e-6);
}

/// A central difference is wrong by step² · f‴ / 6; one of the double step by four times as much,
/// so that the difference of both is three times the error of the first. Its rounding is that of a
/// position, divided by the step.
TEST(FalconKinematics, TheJacobianIsThatOfThePosition) {
  constexpr double kStep_rad = 1e-3;
  for (const Vector3d& at : workspace()) {
    const auto angles = falcon::arm_angles(at);
    const auto jacobian = falcon::jacobian(angles.value(), at);
    ASSERT_TRUE(jacobian) << at.transpose();
    for (int arm = 0; arm < 3; ++arm) {
      const auto slope = [&](double step_rad) -> Vector3d {
        const Vector3d turn = step_rad * Vector3d::Unit(arm);
        return (falcon::grip_position(*angles + turn).value() -
                falcon::grip_position(*angles - turn).value()) /
               (2 * step_rad);
      };
      const Vector3d near = slope(kStep_rad);
      const double tolerance = (slope(2 * kStep_rad) - near).norm() + kRounding_m / kStep_rad;
      ASSERT_LE((jacobian->col(arm) - near).norm(), tolerance) << at.transpose();
      ASSERT_LE(tolerance, 1e-3 * near.norm()) << "says nothing";
    }
  }
}

TEST(FalconKinematics, OutOfReachIsNothing) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const Vector3d& at : {Vector3d(0, 0, 0.06), Vector3d(0, 0, -0.2), Vector3d(0.2, 0, 0),
                             Vector3d(0, -0.15, 0), Vector3d(kNan, 0, 0), Vector3d(0, kNan, 0),
                             Vector3d(0, 0, kNan), Vector3d(kInfinity, 0, 0)})
    EXPECT_FALSE(falcon::arm_angles(at)) << at.transpose();
  for (const Vector3d& angles : {Vector3d(2, 0.5, 0.5), Vector3d(0.5, -1, 0.5),
                                 Vector3d(1.9, -0.8, -0.8), Vector3d(kNan, 0, 0)})
    EXPECT_FALSE(falcon::grip_position(angles)) << angles.transpose();
}

/// Where the far ends of all rods are in the plane of the knees, no angle moves the grip outwards.
TEST(FalconKinematics, FlatRodsDetermineNothing) {
  EXPECT_FALSE(falcon::jacobian(Vector3d::Zero(), Vector3d(0, 0, -0.125)));
}

TEST(FalconKinematics, WhateverTheAnglesAPlaceFitsThemOrThereIsNone) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> angle(-1.0, 2.1);
  int found = 0;
  for (int i = 0; i < 100'000; ++i) {
    const Vector3d angles(angle(random), angle(random), angle(random));
    const auto at = falcon::grip_position(angles);
    if (!at) continue;
    ++found;
    const auto again = falcon::arm_angles(*at);
    ASSERT_TRUE(again) << angles.transpose();
    // Near a stretched arm, its angle follows from the position as from a square root: 1e-9 m of
    // the last step may become 1e-4 rad.
    ASSERT_TRUE(again->isApprox(angles, 1e-4)) << angles.transpose();
  }
  EXPECT_GT(found, 10'000);
}

}  // namespace
}  // namespace spidar::test::falcon_kinematics_test
