// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The tension solver on hard problems, see tension_cases.h.
#include "core/grip/tension_solver.h"
#include "tension_reference.h"
#include "tests/support/tension_cases.h"
#include "tests/support/test.h"

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
  EXPECT_LE(optimality(p, result.tension_N), 1e-12);
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

// After a step that was rejected, one string is released, so that no set of free strings comes
// twice. These problems are not solved when none is; they are rare.
TEST(TensionSolverRejected, EndsWhereStepsAreRejected) {
  constexpr struct {
    unsigned seed;
    int problem;
  } kRare[] = {{1019, 100}, {1079, 344}, {1158, 1745}, {1240, 1682}};
  for (const auto& [seed, problem] : kRare) {
    SCOPED_TRACE(seed);
    Random random(seed);
    for (int n = 0; n < problem; ++n) random_problem(random, TensionCase::kTinyEpsilon);
    const TensionProblem p = random_problem(random, TensionCase::kTinyEpsilon);
    TensionSolver solver;
    check(p, solver.solve(p));
  }
}

}  // namespace
}  // namespace spidar::test::tension_hard_test
