// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/grip/tension_solver.h"
#include "tension_reference.h"
#include "tests/support/tension_cases.h"
#include "tests/support/test.h"

namespace spidar::test::tension_solver_test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

TensionProblem random_problem(Random& random) {
  const double force = uniform(random, 0, 1) < 0.5 ? 3 : 30;
  return g6x3_problem(random_pose(random, 0.04, 1.4),
                      {random_vector(random, force), random_vector(random, force * 0.02)});
}

void expect_within_bounds(const TensionProblem& p, const StringVector& t) {
  for (int i = 0; i < p.count; ++i) {
    EXPECT_GE(t[i], p.t_min_N[i]) << "string " << i;
    EXPECT_LE(t[i], p.t_max_N[i]) << "string " << i;
  }
}

/// What is promised; the objective is strictly convex, so that nothing else is optimal.
void expect_solution(const TensionProblem& p, const StringVector& t) {
  EXPECT_LE(optimality(p, t), 1e-12) << to_line(p);
}

TEST(TensionSolver, FewerStringsAndPointGrips) {
  Random random(3);
  for (int n = 0; n < 200; ++n) {
    TensionProblem p = random_problem(random);
    p.count = 1 + n % 8;
    if (n % 3 == 0) p.W.bottomRows<3>().setZero();
    TensionSolver solver;
    const TensionResult result = solver.solve(p);
    ASSERT_EQ(result.status, TensionStatus::kSolved) << "count " << p.count << ": " << to_line(p);
    expect_within_bounds(p, result.tension_N);
    expect_solution(p, result.tension_N);
    for (int i = p.count; i < kMaxStrings; ++i) EXPECT_EQ(result.tension_N[i], 0);
    if (HasFailure()) break;
  }
}

TEST(TensionSolver, ReportsWhatIsDelivered) {
  // 1 N to the right from the centre is within reach; the pull towards t_ref costs ε-fold.
  const TensionProblem p = g6x3_problem(Pose(), {{1, 0, 0}, {0, 0, 0}});
  TensionSolver solver;
  const TensionResult result = solver.solve(p);
  ASSERT_EQ(result.status, TensionStatus::kSolved);
  const Eigen::Matrix<double, 6, 1> delivered = p.W * result.tension_N;
  EXPECT_LE((delivered - result.delivered.stacked()).norm(), 1e-14);
  Wrench error = result.delivered - p.wrench;
  error.torque_Nm /= p.torque_length_m;
  EXPECT_NEAR(result.residual_N, error.stacked().norm(), 1e-14);
  // ½ r² ≤ objective at any point that gives the wrench exactly, that is ½ ε ‖t − t_ref‖², and such
  // a point exists with tensions below 2.3 N: r² ≤ 1e-4 · 8 · 1.3².
  EXPECT_LE(result.residual_N, std::sqrt(1e-4 * 8 * 1.3 * 1.3));
  EXPECT_LE(result.kkt_residual, 1e-12);
  EXPECT_GE(result.iterations, 1);
}

struct BadInput {
  const char* name;
  void (*spoil)(TensionProblem&);
};

class TensionSolverBadInput : public testing::TestWithParam<BadInput> {};

TEST_P(TensionSolverBadInput, IsRefusedAtRest) {
  TensionProblem p = g6x3_problem(Pose(), {{1, 0, 0}, {0, 0, 0}});
  TensionSolver solver;
  ASSERT_EQ(solver.solve(p).status, TensionStatus::kSolved);
  const TensionProblem good = p;
  GetParam().spoil(p);
  const TensionResult result = solver.solve(p);
  EXPECT_EQ(result.status, TensionStatus::kBadInput);
  for (int i = 0; i < kMaxStrings; ++i) {
    const bool used = i < p.count && std::isfinite(p.t_min_N[i]);
    EXPECT_EQ(result.tension_N[i], used ? p.t_min_N[i] : 0.0) << "string " << i;
  }
  EXPECT_EQ(solver.solve(good).status, TensionStatus::kSolved);
}

INSTANTIATE_TEST_SUITE_P(
    All, TensionSolverBadInput,
    testing::Values(
        BadInput{"NanInW", [](TensionProblem& p) { p.W(2, 3) = kNaN; }},
        BadInput{"InfinityInW", [](TensionProblem& p) { p.W(5, 7) = kInfinity; }},
        BadInput{"NanForce", [](TensionProblem& p) { p.wrench.force_N.y() = kNaN; }},
        BadInput{"InfiniteTorque", [](TensionProblem& p) { p.wrench.torque_Nm.z() = -kInfinity; }},
        BadInput{"NanMinimum", [](TensionProblem& p) { p.t_min_N[1] = kNaN; }},
        BadInput{"InfiniteMaximum", [](TensionProblem& p) { p.t_max_N[6] = kInfinity; }},
        BadInput{"NanReference", [](TensionProblem& p) { p.t_ref_N[0] = kNaN; }},
        BadInput{"CrossedBounds", [](TensionProblem& p) { p.t_max_N[4] = 0.2; }},
        BadInput{"ZeroEpsilon", [](TensionProblem& p) { p.epsilon = 0; }},
        BadInput{"NanEpsilon", [](TensionProblem& p) { p.epsilon = kNaN; }},
        BadInput{"NegativeLength", [](TensionProblem& p) { p.torque_length_m = -1; }},
        BadInput{"OverflowingTensions",
                 [](TensionProblem& p) { p.t_min_N = p.t_max_N = StringVector::Constant(1e308); }},
        BadInput{"NoStrings", [](TensionProblem& p) { p.count = 0; }},
        BadInput{"TooManyStrings", [](TensionProblem& p) { p.count = 9; }}),
    [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace spidar::test::tension_solver_test
