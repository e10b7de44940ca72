// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The tension solver on hard problems, see tension_cases.h.
#include <gtest/gtest.h>

#include "core/grip/tension_solver.h"
#include "tension_reference.h"
#include "tests/support/tension_cases.h"

namespace spidar::test::tension_hard_test {
namespace {

class TensionSolverHard : public testing::TestWithParam<int> {};

void check(const TensionProblem& p, const TensionResult& result) {
  EXPECT_EQ(result.status, TensionStatus::kSolved);
  EXPECT_LE(result.iterations, 24);
  for (int i = 0; i < p.count; ++i) {
    EXPECT_GE(result.tension_N[i], p.t_min_N[i]) << "string " << i;
    EXPECT_LE(result.tension_N[i], p.t_max_N[i]) << "string " << i;
  }
  // What is promised; evaluated in long double from W and f.
  EXPECT_LE(optimality(p, result.tension_N).relative, 1e-12);
  EXPECT_LE(result.kkt_residual, 1e-12);
}

TEST_P(TensionSolverHard, IsSolvedToRounding) {
  const auto c = static_cast<TensionCase>(GetParam());
  Random random(1);
  TensionSolver warm;
  for (int n = 0; n < 20000; ++n) {
    const TensionProblem p = random_problem(random, c);
    TensionSolver cold;
    check(p, cold.solve(p));
    check(p, warm.solve(p));  // from the solution of something else
    if (HasFailure()) FAIL() << name(c) << ", case " << n << ":\n" << to_line(p);
  }
}

INSTANTIATE_TEST_SUITE_P(All, TensionSolverHard, testing::Range(0, kTensionCases));

// Along a smooth path the tensions move smoothly. For two problems with the same bounds the
// solutions of strongly convex problems differ by at most ‖∇₁(t₂) − ∇₂(t₂)‖ / ε₀, ε₀ the smallest
// curvature, which is ε: a bound that is far from sharp but that no jump between two solutions
// would keep.
TEST(TensionSolverPath, StepsAreWithinTheConditioning) {
  TensionSolver solver;
  TensionProblem last;
  StringVector last_t = StringVector::Zero();
  for (int tick = 0; tick < 5000; ++tick) {
    const double t = tick * 1e-3;
    Pose pose;
    pose.position_m = 0.03 * Eigen::Vector3d(std::sin(9 * t), std::sin(7 * t), std::sin(11 * t));
    pose.orientation = Eigen::AngleAxisd(std::sin(3 * t), Eigen::Vector3d(1, 2, -1).normalized());
    const TensionProblem p = g6x3_problem(
        pose, {4 * Eigen::Vector3d(std::sin(13 * t), std::sin(17 * t), std::cos(5 * t)),
               0.03 * Eigen::Vector3d(std::sin(8 * t), std::cos(6 * t), std::sin(4 * t))});
    const StringVector now = solver.solve(p).tension_N;
    if (tick > 0) {
      const detail::Objective a(last), b(p);
      const detail::LongVector there = now.cast<detail::Long>();
      const detail::LongVector change = (a.Q * there - a.c) - (b.Q * there - b.c);
      const auto bound = static_cast<double>(change.norm()) / p.epsilon;
      ASSERT_LE((now - last_t).norm(), bound) << "tick " << tick << ":\n" << to_line(p);
    }
    last = p;
    last_t = now;
  }
}

}  // namespace
}  // namespace spidar::test::tension_hard_test
