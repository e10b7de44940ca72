// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Tensions do not jump along a smooth path: no tick changes a string by more than the conditioning
// of the problem allows.

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "core/grip/tension_solver.h"
#include "tension_reference.h"
#include "tests/support/grip_path.h"
#include "tests/support/string_samples.h"
#include "tests/support/tension_cases.h"
#include "tests/support/tension_step.h"

namespace spidar::test::tension_continuity_test {
namespace {

constexpr double kTick_s = 0.001;
constexpr int kTicks = 1000;

/// As in the haptic loop: the minimum tensions are the reference.
TensionProblem loop_problem(const Pose& pose, const Wrench& wrench) {
  TensionProblem p = g6x3_problem(pose, wrench);
  p.t_ref_N = p.t_min_N;
  return p;
}

struct Walk {
  double nearest = 0;  // largest step / bound of a tick
  int active_set_changes = 0;
  int ticks_beyond_reach = 0;
};

unsigned strings_at_bounds(const TensionProblem& p, const StringVector& t) {
  unsigned set = 0;
  for (int i = 0; i < p.count; ++i)
    set |= static_cast<unsigned>(t[i] == p.t_min_N[i] || t[i] == p.t_max_N[i]) << i;
  return set;
}

// What the solver returns is not exact: its optimality conditions are violated by up to 1e-12 of
// `scale` in each of 8 strings (what it promises), so it is the exact solution of a problem whose
// linear term is off by v, ‖v‖ ≤ √8 · 1e-12 · scale. With v in g a slope Q_FF⁻¹ g_F changes by
// ‖v‖ / λmin(Q_FF) at most, and λmin(Q_FF) ≥ ε. Both ends of the step have such a v. Rounding in g
// itself is some 1e-15 of the same scale, and the factorisation loses the condition of Q, some 1e5,
// times 1e-16 of a slope of newtons: both go under in this.
double solver_error_N(const TensionProblem& p, const StringVector& t) {
  return std::sqrt(8.0) * 1e-12 * optimality(p, t).scale / p.epsilon;
}

Walk walk(const PathLimits& limits, uint64_t seed) {
  Random random(seed);
  const GripPath path(random, limits);
  TensionSolver solver;
  TensionProblem last;
  StringVector last_t;
  Walk sum;
  for (int tick = 0; tick <= kTicks; ++tick) {
    const TensionProblem p = loop_problem(path.pose(tick * kTick_s), path.wrench(tick * kTick_s));
    const TensionResult result = solver.solve(p);
    EXPECT_EQ(result.status, TensionStatus::kSolved) << to_line(p);
    if (tick > 0) {
      const TensionStep step = tension_step(last, last_t, p, result.tension_N);
      const double error_N = solver_error_N(last, last_t) + solver_error_N(p, result.tension_N);
      EXPECT_LE(step.largest_N, step.piecewise_N + error_N)
          << "seed " << seed << " tick " << tick << ":\n"
          << to_line(last) << '\n'
          << to_line(p);
      EXPECT_LE((result.tension_N - last_t).norm(), step.lipschitz_N + error_N)
          << "seed " << seed << " tick " << tick << ":\n"
          << to_line(last) << '\n'
          << to_line(p);
      // A step that exceeds the solver's error shows how tight the bound is.
      if (step.largest_N > 1e3 * error_N)
        sum.nearest = std::max(sum.nearest, step.largest_N / step.piecewise_N);
      sum.active_set_changes +=
          strings_at_bounds(last, last_t) != strings_at_bounds(p, result.tension_N);
      sum.ticks_beyond_reach += result.residual_N > 0.1 * p.wrench.force_N.norm();
    }
    last = p;
    last_t = result.tension_N;
    if (testing::Test::HasFailure()) break;
  }
  return sum;
}

class TensionContinuity : public testing::TestWithParam<uint64_t> {};

// Reaching the bound shows that it is no wider than necessary.
TEST_P(TensionContinuity, WithinReach) {
  const Walk sum = walk(PathLimits(), GetParam());
  EXPECT_GT(sum.nearest, 0.99);
  EXPECT_GT(sum.active_set_changes, 10);
}

TEST_P(TensionContinuity, FarAndTurned) {
  const Walk sum = walk(far_and_turned(), GetParam());
  EXPECT_GT(sum.nearest, 0.99);
  EXPECT_GT(sum.active_set_changes, 10);
  EXPECT_GT(sum.ticks_beyond_reach, 0);
  EXPECT_LT(sum.ticks_beyond_reach, kTicks);
}

TEST_P(TensionContinuity, BeyondReach) {
  const Walk sum = walk(beyond_reach(), GetParam());
  EXPECT_GT(sum.nearest, 0.99);
  EXPECT_GT(sum.active_set_changes, 10);
  EXPECT_GT(sum.ticks_beyond_reach, kTicks / 2);
}

INSTANTIATE_TEST_SUITE_P(Seeds, TensionContinuity, testing::Range<uint64_t>(1, 6));

// Tensions that balance themselves change nothing at the grip but are not the minimum: a solver
// that went from one to the other would pass every test of the wrench.
TEST(TensionStep, JumpOfBalancedTensionsIsAboveTheBound) {
  const TensionProblem p = loop_problem(Pose(), {{1, 0, 0}, {0, 0, 0}});
  TensionSolver solver;
  const StringVector t = solver.solve(p).tension_N;
  const StringVector balanced = 0.1 * p.W.fullPivLu().kernel().col(0).normalized();
  const TensionStep step = tension_step(p, t, p, t + balanced);
  // The largest of eight parts of a vector that is 0.1 long.
  EXPECT_GE(step.largest_N, 0.1 / std::sqrt(8.0) - 1e-12);
  EXPECT_LT(step.lipschitz_N, 0.01);
  EXPECT_LT(step.piecewise_N, 0.01);
}

}  // namespace
}  // namespace spidar::test::tension_continuity_test
