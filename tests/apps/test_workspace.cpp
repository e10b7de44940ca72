// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <algorithm>
#include <cmath>

#include <Eigen/QR>
#include <gtest/gtest.h>

#include "apps/workspace/delivery.h"
#include "apps/workspace/force_closure.h"
#include "tests/support/string_samples.h"

namespace spidar::test {
namespace {

constexpr double kGripRadius_m = 0.0225;

ForceClosure closure_of(const StructureMatrix& W, int count, double t_min_N = 0.3,
                        double t_max_N = 20) {
  return force_closure(W, count, kGripRadius_m, StringVector::Constant(t_min_N),
                       StringVector::Constant(t_max_N));
}

// Least over largest tension, by going round an orthonormal basis of the null space in small steps.
double scanned_tension_factor(const StructureMatrix& W, int steps) {
  const Eigen::HouseholderQR<Eigen::Matrix<double, kMaxStrings, 6>> qr(W.transpose());
  const Eigen::Matrix<double, kMaxStrings, kMaxStrings> basis = qr.householderQ();
  const Eigen::Matrix<double, kMaxStrings, 2> N = basis.rightCols<2>();
  double best = 0;
  for (int k = 0; k < steps; ++k) {
    const double angle = 2 * M_PI * k / steps;
    const StringVector t = N * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    if (t.minCoeff() > 0) best = std::max(best, t.minCoeff() / t.maxCoeff());
  }
  return best;
}

// How far from balance a hundredth is: t within bounds is n + r with W n = 0 and a residual of
// σ₆‖r‖ or more, σ₆ the least singular value. From (1.01 factor − ‖r‖) ≤ min nᵢ ≤ factor max nᵢ ≤
// factor (1 + ‖r‖) follows ‖r‖ ≥ 0.01 factor / (1 + factor): far above what counts as balance
// unless the pose is at the border to 1e-4.
//
// Can tensions within [t_min, t_max] have no wrench? At ε = 1e-16 what is left of the residual is
// √ε‖t_max − t_min‖ ≤ 3e-8 N if they can, as in Deliverer::delivers_exactly().
bool solver_finds_balance(const StructureMatrix& W, double t_min_N, double t_max_N) {
  TensionProblem p;
  p.W = W;
  p.t_min_N.setConstant(t_min_N);
  p.t_max_N.setConstant(t_max_N);
  p.t_ref_N = p.t_min_N;
  p.epsilon = 1e-16;
  p.torque_length_m = kGripRadius_m;
  TensionSolver solver;
  return solver.solve(p).residual_N <= 1e-8 * (p.t_max_N - p.t_min_N).norm();
}

TEST(ForceClosure, TensionFactorIsTheBestOfTheNullSpace) {
  Random random(1);
  int closed = 0;
  for (int n = 0; n < 100; ++n) {
    const StructureMatrix W = structure_matrix(g6x3_geometry(), random_pose(random, 0.03, 0.8));
    const double factor = closure_of(W, 8).tension_factor;
    const double scanned = scanned_tension_factor(W, 20000);
    closed += factor > 0;
    EXPECT_LE(scanned, factor + 1e-9) << "pose " << n << " of seed 1";
    // The scan misses the best direction by half a step at most, 1.6e-4 rad, and so has every
    // tension of a unit vector, the largest of which is 1/√8 or more: 2 · 1.6e-4 · √8 < 1e-3.
    EXPECT_GE(scanned, factor - 1e-3) << "pose " << n << " of seed 1";
  }
  EXPECT_GT(closed, 20);
  EXPECT_LT(closed, 80);
}

TEST(ForceClosure, BoundsAgreeWithTheSolver) {
  Random random(2);
  int balanced = 0;
  for (int n = 0; n < 200; ++n) {
    const StructureMatrix W = structure_matrix(g6x3_geometry(), random_pose(random, 0.03, 0.8));
    const double factor = closure_of(W, 8).tension_factor;
    if (factor == 0) {
      EXPECT_FALSE(closure_of(W, 8).balanced_within_bounds) << "pose " << n << " of seed 2";
      continue;
    }
    ++balanced;
    // With the same bounds for all strings the least must be `factor` of the largest.
    EXPECT_TRUE(closure_of(W, 8, 0.99 * factor, 1).balanced_within_bounds) << n;
    EXPECT_TRUE(solver_finds_balance(W, 0.99 * factor, 1)) << "pose " << n << " of seed 2";
    if (1.01 * factor > 1) continue;
    EXPECT_FALSE(closure_of(W, 8, 1.01 * factor, 1).balanced_within_bounds) << n;
    EXPECT_FALSE(solver_finds_balance(W, 1.01 * factor, 1)) << "pose " << n << " of seed 2";
  }
  EXPECT_GT(balanced, 50);
}

TEST(ForceClosure, SixStringsNeverCloseAndSevenCan) {
  // Six unit wrenches and one against them all: t = (1 … 1) balances.
  StructureMatrix W = StructureMatrix::Zero();
  W.leftCols<6>().setIdentity();
  W.col(6).setConstant(-1);
  EXPECT_EQ(closure_of(W, 6).tension_factor, 0);
  EXPECT_NEAR(closure_of(W, 7).tension_factor, 1, 1e-12);
  EXPECT_TRUE(closure_of(W, 7).balanced_within_bounds);
  W.col(6) *= 2;  // the seventh pulls half as much
  EXPECT_NEAR(closure_of(W, 7).tension_factor, 0.5, 1e-12);
  W(0, 6) = 2;  // nothing pulls back in x
  EXPECT_EQ(closure_of(W, 7).tension_factor, 0);
}

TEST(ForceClosure, PointGripCannotTakeTorque) {
  StringGeometry geometry = g6x3_geometry();
  for (Eigen::Vector3d& knot : geometry.grip_m) knot.setZero();
  const ForceClosure closure = closure_of(structure_matrix(geometry, Pose()), 8);
  EXPECT_EQ(closure.tension_factor, 0);
  EXPECT_FALSE(closure.balanced_within_bounds);
}

// The published objective, written out: λt = 1, λr = 6, s = 0.3.
double published_objective(const TensionProblem& p, const StringVector& t) {
  const Eigen::Matrix<double, 6, 1> error = p.W * t - p.wrench.stacked();
  return error.head<3>().squaredNorm() + 6 * error.tail<3>().squaredNorm() + 0.3 * t.squaredNorm();
}

TEST(Delivery, PublishedWeightsMinimiseThePublishedObjective) {
  Random random(3);
  TensionProblem p;
  p.t_min_N.setConstant(0.3);
  p.t_max_N.setConstant(20);
  p.t_ref_N = published_weights().t_ref_N;
  p.epsilon = published_weights().epsilon;
  p.torque_length_m = published_weights().torque_length_m;
  for (int n = 0; n < 50; ++n) {
    p.W = structure_matrix(g6x3_geometry(), random_pose(random, 0.03, 0.8));
    p.wrench = {3 * random_direction(random), 0.1 * random_direction(random)};
    TensionSolver solver;
    const StringVector t = solver.solve(p).tension_N;
    const double least = published_objective(p, t);
    // The objective is convex: no string is better off a little lower or higher. Rounding of the
    // objective, some 10 N², is 1e-15 of it.
    for (int i = 0; i < kMaxStrings; ++i) {
      for (const double step_N : {-1e-3, 1e-3}) {
        StringVector other = t;
        other[i] = std::clamp(t[i] + step_N, p.t_min_N[i], p.t_max_N[i]);
        EXPECT_GE(published_objective(p, other), least - 1e-13) << "pose " << n << " of seed 3";
      }
    }
  }
}

TEST(Delivery, DirectionsAreEven) {
  const std::vector<Eigen::Vector3d> directions = even_directions(32);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& d : directions) {
    EXPECT_NEAR(d.norm(), 1, 1e-12);
    sum += d;
    double nearest = 2;
    for (const Eigen::Vector3d& other : directions)
      if (&d != &other) nearest = std::min(nearest, (d - other).norm());
    // 32 caps of the same size that fill the sphere are √(4/32) · 2 = 0.71 across; a lattice leaves
    // room between them.
    EXPECT_GT(nearest, 0.71 / 2);
  }
  EXPECT_LT(sum.norm() / 32, 0.05);
}

}  // namespace
}  // namespace spidar::test
