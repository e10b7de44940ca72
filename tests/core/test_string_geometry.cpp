// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/grip/string_geometry.h"
#include "tests/support/string_samples.h"
#include "tests/support/test.h"

namespace spidar::test::string_geometry_test {
namespace {

TEST(StringGeometry, HomeLengthsAreThePublishedOnes) {
  const StringVector lengths = string_lengths_m(g6x3_geometry(), Pose());
  // The table gives hundredths of a millimetre.
  for (int i = 0; i < 8; ++i)
    EXPECT_NEAR(lengths[i], i % 4 < 2 ? 103.84e-3 : 100.31e-3, 0.5e-5) << "string " << i;
}

TEST(StringGeometry, GripRadiusIsTheMeanArm) {
  EXPECT_NEAR(g6x3_geometry().grip_radius_m(), 0.0225, 1e-15);
  EXPECT_EQ(StringGeometry().grip_radius_m(), 0);
}

// Virtual work: a twist (v, ω) of the grip changes the lengths by −Wᵀ (v, ω). A central difference
// of step h errs by h² l‴/6, with |l‴| below 3/l² for a translation (l ≥ 2 cm here) and of the same
// size for a rotation times the arm, plus rounding 2⁻⁵³ l/h: 1e-10/6 · 7.5e3 + 1e-16 · 0.2/1e-5.
TEST(StringGeometry, StructureMatrixIsTheDerivativeOfTheLengths) {
  constexpr double kStep = 1e-5;
  constexpr double kTolerance = 3e-7;
  const StringGeometry geometry = g6x3_geometry();
  Random random(1);
  for (int n = 0; n < 200; ++n) {
    const Pose pose = random_pose(random, 0.04, 1.4);
    const StructureMatrix W = structure_matrix(geometry, pose);
    for (int axis = 0; axis < 6; ++axis) {
      StringVector lengths[2];
      for (int side = 0; side < 2; ++side) {
        const double h = side ? kStep : -kStep;
        Pose moved = pose;
        if (axis < 3) {
          moved.position_m[axis] += h;
        } else {
          const Eigen::Quaterniond turn(Eigen::AngleAxisd(h, Eigen::Vector3d::Unit(axis - 3)));
          moved.orientation = turn * pose.orientation;
        }
        lengths[side] = string_lengths_m(geometry, moved);
      }
      const StringVector slope = (lengths[1] - lengths[0]) / (2 * kStep);
      EXPECT_LE((slope + W.row(axis).transpose()).cwiseAbs().maxCoeff(), kTolerance)
          << "case " << n << ", axis " << axis;
    }
  }
}

TEST(StringGeometry, UnusedStringsAreZero) {
  StringGeometry geometry = g6x3_geometry();
  geometry.count = 6;
  EXPECT_EQ(string_lengths_m(geometry, Pose()).tail<2>().norm(), 0);
  EXPECT_EQ(structure_matrix(geometry, Pose()).rightCols<2>().norm(), 0);
}

TEST(StringGeometry, StringWithoutLengthHasNoDirection) {
  StringGeometry geometry = g6x3_geometry();
  geometry.exit_m[3] = geometry.grip_m[3];
  const StructureMatrix W = structure_matrix(geometry, Pose());
  EXPECT_EQ(W.col(3).norm(), 0);
  EXPECT_TRUE(W.allFinite());
}

}  // namespace
}  // namespace spidar::test::string_geometry_test
