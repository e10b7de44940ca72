#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

#include "core/pose_solver.h"
#include "string_samples.h"

namespace spidar::test {
namespace {

// With exact lengths the only error left is that of stopping and of rounding. Lengths are rounded
// to 2⁻⁵³ · 0.2 m ≈ 2e-17 m, and the worst conditioned Jacobian of these poses amplifies by less
// than 100; steps below the tolerance of the solver (1e-8 of the way) weigh more.
constexpr double kExact_m = 1e-9;
constexpr double kExact_rad = 1e-7;

void expect_same(const Pose& wanted, const Pose& got) {
  EXPECT_LE((wanted.position_m - got.position_m).norm(), kExact_m);
  EXPECT_LE(wanted.orientation.angularDistance(got.orientation), kExact_rad);
  EXPECT_NEAR(got.orientation.norm(), 1, 1e-15);
}

TEST(PoseSolver, InvertsTheForwardKinematicsOverTheWorkspace) {
  const StringGeometry geometry = g6x3_geometry();
  Random random(1);
  for (int n = 0; n < 500; ++n) {
    // ±4 cm and 45°: from the centre there is no other minimum on the way.
    const Pose pose = random_pose(random, 0.04, M_PI / 4);
    PoseSolver solver(geometry);
    const PoseResult result = solver.solve(string_lengths_m(geometry, pose));
    ASSERT_EQ(result.status, PoseStatus::kSolved) << "case " << n;
    expect_same(pose, result.pose);
    EXPECT_LE(result.residual_m, kExact_m);
    if (HasFailure()) FAIL() << "case " << n;
  }
}

TEST(PoseSolver, FollowsAMotion) {
  const StringGeometry geometry = g6x3_geometry();
  PoseSolver solver(geometry);
  for (int tick = 0; tick < 5000; ++tick) {
    const double t = tick * 1e-3;
    Pose pose;
    pose.position_m = 0.03 * Eigen::Vector3d(std::sin(9 * t), std::sin(7 * t), std::sin(11 * t));
    pose.orientation = Eigen::AngleAxisd(std::sin(3 * t), Eigen::Vector3d(1, 2, -1).normalized());
    const PoseResult result = solver.solve(string_lengths_m(geometry, pose));
    ASSERT_EQ(result.status, PoseStatus::kSolved) << "tick " << tick;
    expect_same(pose, result.pose);
    if (HasFailure()) FAIL() << "tick " << tick;
  }
}

TEST(PoseSolver, LengthsThatFitNoPoseAreReported) {
  const StringGeometry geometry = g6x3_geometry();
  PoseSolver solver(geometry);
  Pose pose;
  pose.position_m = {0.01, -0.005, 0.02};
  StringVector lengths = string_lengths_m(geometry, pose);
  ASSERT_EQ(solver.solve(lengths).status, PoseStatus::kSolved);
  lengths[2] += 0.02;
  lengths[5] += 0.02;
  const PoseResult result = solver.solve(lengths);
  EXPECT_EQ(result.status, PoseStatus::kNotConverged);
  EXPECT_GT(result.residual_m, PoseSolver::kMaxResidual_m);
  expect_same(pose, result.pose);
}

TEST(PoseSolver, BadLengthsAreRefusedAndTheLastPoseKept) {
  const StringGeometry geometry = g6x3_geometry();
  PoseSolver solver(geometry);
  Pose pose;
  pose.position_m = {0.01, 0, 0};
  const StringVector good = string_lengths_m(geometry, pose);
  ASSERT_EQ(solver.solve(good).status, PoseStatus::kSolved);
  for (double bad :
       {-1e-3, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    StringVector lengths = good;
    lengths[4] = bad;
    const PoseResult result = solver.solve(lengths);
    EXPECT_EQ(result.status, PoseStatus::kBadInput) << bad;
    expect_same(pose, result.pose);
  }
}

TEST(PoseSolver, ResetChoosesTheStart) {
  const StringGeometry geometry = g6x3_geometry();
  Pose pose;
  pose.orientation = Eigen::AngleAxisd(1.4, Eigen::Vector3d::UnitX());
  PoseSolver solver(geometry);
  solver.reset(pose);
  const PoseResult result = solver.solve(string_lengths_m(geometry, pose));
  EXPECT_EQ(result.status, PoseStatus::kSolved);
  expect_same(pose, result.pose);
}

TEST(PoseSolver, RefusesGeometriesThatCannotTellAPose) {
  StringGeometry five = g6x3_geometry();
  five.count = 5;
  EXPECT_THROW(PoseSolver{five}, std::invalid_argument);
  StringGeometry point = g6x3_geometry();
  point.grip_m.fill(Eigen::Vector3d::Zero());
  EXPECT_THROW(PoseSolver{point}, std::invalid_argument);
}

}  // namespace
}  // namespace spidar::test
