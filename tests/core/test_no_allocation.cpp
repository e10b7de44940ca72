// The solvers run in the haptic thread, which must not touch the heap, on good input or bad.
#include <array>
#include <limits>
#include <memory>

#include <gtest/gtest.h>

#include "core/grip/pose_solver.h"
#include "core/grip/tension_solver.h"
#include "count_allocations.h"
#include "tension_cases.h"

namespace spidar::test {
namespace {

TEST(NoAllocation, TheCounterCounts) {
  if (!kCountsAllocations) GTEST_SKIP() << "a sanitizer has the heap";
  const size_t before = allocations;
  const auto something = std::make_unique<std::array<double, 100>>();
  EXPECT_NE(something, nullptr);
  EXPECT_GT(allocations, before);
}

TEST(NoAllocation, TensionSolver) {
  Random random(1);
  TensionSolver solver;
  for (int n = 0; n < 12 * 200; ++n) {
    TensionProblem p = random_problem(random, static_cast<TensionCase>(n % kTensionCases));
    if (n % 100 == 0) p.W(0, 0) = std::numeric_limits<double>::quiet_NaN();
    const size_t before = allocations;
    solver.solve(p);
    ASSERT_EQ(allocations, before) << "case " << n;
  }
}

TEST(NoAllocation, PoseSolver) {
  const StringGeometry geometry = g6x3_geometry();
  Random random(2);
  PoseSolver solver(geometry);
  for (int n = 0; n < 500; ++n) {
    StringVector lengths = string_lengths_m(geometry, random_pose(random, 0.05, 1.4));
    if (n % 3 == 0) lengths[n % 8] += 0.01;     // one is wrong
    if (n % 7 == 0) lengths.setConstant(0.01);  // all are
    if (n % 50 == 0) lengths[0] = std::numeric_limits<double>::quiet_NaN();
    const size_t before = allocations;
    solver.solve(lengths);
    ASSERT_EQ(allocations, before) << "case " << n;
  }
}

}  // namespace
}  // namespace spidar::test
