// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Time and error of the tension solver: while a hand moves, and on hard problems, among them
// problems of every shipped profile. The optional argument is the number of hard problems of each
// family (default 30000).
//
// KKT is the largest violation of the optimality conditions in long double, relative to |Q||t| +
// |c|. A case fails when it is above 1e-12, a bound is exceeded, or more than 24 rounds are needed.
// max* is the slowest case, each case being timed by its fastest pass, which excludes
// interruptions. Compare times within one run only; absolute times depend on the machine.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "core/grip/tension_solver.h"
#include "spidar/profiles/profile.h"
#include "tests/bench/benchmarks.h"
#include "tests/bench/call_timer.h"
#include "tests/core/tension_reference.h"
#include "tests/spidar/profile_tension_cases.h"
#include "tests/support/tension_cases.h"

namespace {

using namespace spidar;
using namespace spidar::bench;

constexpr int kPasses = 7;

bool is_right(const TensionProblem& p, const TensionResult& result, double kkt) {
  bool within = true;
  for (int k = 0; k < p.count; ++k)
    within = within && result.tension_N[k] >= p.t_min_N[k] && result.tension_N[k] <= p.t_max_N[k];
  return kkt <= 1e-12 && within && result.status == TensionStatus::kSolved &&
         result.iterations <= 24;
}

/// 4 s of a hand that moves with up to 0.4 m/s and 2 rad/s while force and torque go round.
std::vector<TensionProblem> trajectory() {
  std::vector<TensionProblem> problems;
  for (int tick = 0; tick < 4000; ++tick) {
    const double t = tick * 1e-3;
    Pose pose;
    pose.position_m =
        0.02 * Eigen::Vector3d(std::sin(9 * t), std::sin(7 * t + 1), std::sin(11 * t + 2));
    pose.orientation =
        Eigen::AngleAxisd(0.6 * std::sin(3 * t), Eigen::Vector3d(1, 2, -1).normalized());
    problems.push_back(test::g6x3_problem(
        pose, {3 * Eigen::Vector3d(std::sin(13 * t), std::sin(17 * t), std::cos(5 * t)),
               0.03 * Eigen::Vector3d(std::sin(8 * t), std::cos(6 * t), std::sin(4 * t))}));
  }
  return problems;
}

/// Each tick from the solution of the one before, or from nothing.
void print_trajectory(bool warm) {
  const std::vector<TensionProblem> problems = trajectory();
  std::vector<TensionResult> found(problems.size());
  TensionSolver solver;
  const CallTimes ns = time_calls(
      problems.size(), kPasses, [&] { solver.reset(); },
      [&](size_t i) {
        if (!warm) solver.reset();
        found[i] = solver.solve(problems[i]);
      });
  std::vector<double> kkt;
  int failed = 0;
  for (size_t i = 0; i < problems.size(); ++i) {
    kkt.push_back(test::optimality(problems[i], found[i].tension_N));
    failed += !is_right(problems[i], found[i], kkt.back());
  }
  std::printf("%-26s %7.0f %7.0f %7.0f %7.0f %9.1e %9.1e %7d\n", warm ? "warm" : "cold",
              quantile(ns.median, 0.5), quantile(ns.median, 0.99), quantile(ns.median, 1),
              quantile(ns.least, 1), quantile(kkt, 0.5), quantile(kkt, 1), failed);
}

constexpr int kTimed = 2000;  // cases of a family

struct Totals {
  long cases = 0;
  long failed = 0;
};

template <typename Draw>
void run_family(const std::string& name, int count, Totals& totals, Draw draw) {
  test::Random random(2);
  std::vector<TensionProblem> timed;
  TensionSolver warm;
  int failed = 0, most = 0;
  double worst = 0, sum = 0;
  for (int i = 0; i < count; ++i) {
    const TensionProblem p = draw(random);
    if (i < kTimed) timed.push_back(p);
    TensionSolver cold;
    for (TensionSolver* solver : {&cold, &warm}) {  // warm: from the solution of something else
      const TensionResult result = solver->solve(p);
      const double kkt = test::optimality(p, result.tension_N);
      failed += !is_right(p, result, kkt);
      worst = std::max(worst, kkt);
      most = std::max(most, result.iterations);
      sum += result.iterations;
    }
  }
  TensionSolver solver;
  const CallTimes ns = time_calls(
      timed.size(), kPasses, [] {},
      [&](size_t i) {
        solver.reset();
        solver.solve(timed[i]);
      });
  std::printf("%-26s %7.0f %7.0f %7.0f %7.0f %9.1e %7.2f %5d %7d\n", name.c_str(),
              quantile(ns.median, 0.5), quantile(ns.median, 0.99), quantile(ns.median, 1),
              quantile(ns.least, 1), worst, sum / (2.0 * count), most, failed);
  totals.cases += 2L * count;
  totals.failed += failed;
}

}  // namespace

int spidar::bench::tension(int argc, char** argv) {
  const int count = std::max(argc > 1 ? std::atoi(argv[1]) : 30000, 1);
  pin_to_one_core();
  std::printf("1 kHz trajectory, 4000 problems\n%-26s %7s %7s %7s %7s %9s %9s %7s\n", "", "med ns",
              "99 %", "max", "max*", "KKT med", "KKT max", "failed");
  print_trajectory(true);
  print_trajectory(false);
  std::printf(
      "\nhard problems, cold starts timed by %d passes\n%-26s %7s %7s %7s %7s %9s %7s %5s %7s\n",
      kPasses, "", "med ns", "99 %", "max", "max*", "KKT max", "rounds", "most", "failed");
  Totals totals;
  for (int c = 0; c < test::kTensionCases; ++c) {
    const auto family = static_cast<test::TensionCase>(c);
    run_family(test::name(family), count, totals,
               [family](test::Random& random) { return test::random_problem(random, family); });
  }
  for (const std::string& name : list_profiles()) {
    const Profile profile = load_profile(name);
    run_family(name, count, totals,
               [&profile](test::Random& random) { return test::random_problem(random, profile); });
  }
  std::printf("%ld solutions, cold and warm, %ld failed\n", totals.cases, totals.failed);
  return totals.failed > 0;
}
