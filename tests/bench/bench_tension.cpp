// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Compares the tension solver with others, in nanoseconds and error, on problems of a real device
// and on hard ones.
//
// KKT is the largest violation of the optimality conditions in long double, relative to |Q||t| +
// |c|. A case fails when it is above 1e-9, or a bound is exceeded by more than 1e-9 of the largest
// tension. max* is the slowest case, each case being timed by its fastest pass, which excludes
// interruptions. Compare times within one run only; absolute times depend on the machine.
#include <cmath>
#include <cstdio>
#include <memory>
#include <vector>

#include "core/grip/tension_solver.h"
#include "tests/bench/benchmarks.h"
#include "tests/bench/call_timer.h"
#include "tests/bench/tension_peers.h"
#include "tests/core/tension_reference.h"
#include "tests/support/tension_cases.h"

namespace {

using namespace spidar;
using namespace spidar::bench;
using test::TensionCase;

struct Quality {
  std::vector<double> kkt;
  int failures = 0;

  void add(const TensionProblem& p, const StringVector& t) {
    const double k = t.allFinite() ? test::optimality(p, clipped(p, t)).relative : INFINITY;
    double outside = 0;
    for (int i = 0; i < p.count; ++i)
      outside = std::max({outside, p.t_min_N[i] - t[i], t[i] - p.t_max_N[i]});
    kkt.push_back(k);
    failures += !(k <= 1e-9) || outside > 1e-9 * t.cwiseAbs().maxCoeff();
  }
};

void compare(const char* title, const std::vector<TensionProblem>& problems,
             const std::vector<std::unique_ptr<Peer>>& peers) {
  std::printf("\n%s, %zu problems\n%-28s %9s %9s %9s %9s %9s %9s %9s\n", title, problems.size(), "",
              "median ns", "99 % ns", "max ns", "max*", "KKT med", "KKT max", "failures");
  for (const auto& peer : peers) {
    std::vector<StringVector> t(problems.size());
    const CallTimes ns = time_calls(
        problems.size(), peer->passes(), [&] { peer->forget(); },
        [&](size_t i) { t[i] = peer->solve(problems[i]); });
    Quality quality;
    for (size_t i = 0; i < problems.size(); ++i) quality.add(problems[i], t[i]);
    std::printf("%-28s %9.0f %9.0f %9.0f %9.0f %9.1e %9.1e %9d\n", peer->name(),
                quantile(ns.median, 0.5), quantile(ns.median, 0.99), quantile(ns.median, 1),
                quantile(ns.least, 1), quantile(quality.kkt, 0.5), quantile(quality.kkt, 1),
                quality.failures);
  }
}

std::vector<TensionProblem> easy_problems() {
  test::Random random(1);
  std::vector<TensionProblem> problems;
  for (int i = 0; i < 1000; ++i)
    problems.push_back(
        test::random_problem(random, i % 2 ? TensionCase::kNearCentre : TensionCase::kReachable));
  return problems;
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

/// What the weights that Springhead's HISpidarG sets by default deliver: smoothing 0.3 on the
/// tensions, 6 on the squared torque error in N·m, solved exactly.
void published_weights() {
  test::Random random(3);
  TensionSolver ours, theirs;
  std::vector<double> our_force, their_force, our_torque, their_torque;
  for (int i = 0; i < 2000; ++i) {
    TensionProblem p = test::g6x3_problem(test::random_pose(random, 0.02, 0.35),
                                          {3 * test::random_direction(random), {0, 0, 0}});
    const auto add = [&p](const TensionResult& r, std::vector<double>& f, std::vector<double>& t) {
      f.push_back(r.delivered.force_N.dot(p.wrench.force_N) / 3);
      t.push_back(1e3 * r.delivered.torque_Nm.norm());
    };
    add(ours.solve(p), our_force, our_torque);
    p.epsilon = 0.3;
    p.t_ref_N.setZero();
    p.torque_length_m = 1 / std::sqrt(6.0);
    add(theirs.solve(p), their_force, their_torque);
  }
  std::printf(
      "\n3 N wanted within 2 cm and 20 deg, delivered: median (least) N, median (most) N·mm\n");
  std::printf("%-28s %6.2f (%4.2f) %6.1f (%4.1f)\n", "ours", quantile(our_force, 0.5),
              quantile(our_force, 0), quantile(our_torque, 0.5), quantile(our_torque, 1));
  std::printf("%-28s %6.2f (%4.2f) %6.1f (%4.1f)\n", "published weights 0.3 and 6",
              quantile(their_force, 0.5), quantile(their_force, 0), quantile(their_torque, 0.5),
              quantile(their_torque, 1));
}

}  // namespace

int spidar::bench::tension(int, char**) {
  pin_to_one_core();
  std::vector<std::unique_ptr<Peer>> peers;
  peers.push_back(std::make_unique<Ours>(false));
  peers.push_back(std::make_unique<Ours>(true));
  peers.push_back(std::make_unique<EigenLdlt>());
  peers.push_back(std::make_unique<EigenCod>());
  peers.push_back(std::make_unique<GaussSeidel>());
  peers.push_back(std::make_unique<CeresBounded>());
  compare("1 kHz trajectory", trajectory(), peers);
  peers.erase(peers.begin() + 1);
  compare("unrelated easy problems", easy_problems(), peers);
  for (int c = 2; c < test::kTensionCases - 1; ++c) {
    test::Random random(4);
    std::vector<TensionProblem> problems;
    for (int i = 0; i < 400; ++i)
      problems.push_back(test::random_problem(random, static_cast<TensionCase>(c)));
    compare(test::name(static_cast<TensionCase>(c)), problems, peers);
  }
  published_weights();
  return 0;
}
