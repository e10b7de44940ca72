// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// What the strings of each profile leave of a wanted 3 N, for the table of docs/strings.md.
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "core/grip/tension_solver.h"
#include "spidar/profiles/profile.h"
#include "tests/bench/benchmarks.h"
#include "tests/bench/call_timer.h"
#include "tests/support/string_samples.h"

namespace {

using namespace spidar;
using namespace spidar::test;

constexpr double kForce_N = 3;
constexpr int kPoses = 4000;

/// How near to the centre: the cube of positions, and the largest turn about any axis.
struct Near {
  double reach_m, turn_rad;
};

constexpr Near kNear[] = {
    {0.02, 20 * M_PI / 180}, {0.05, 80 * M_PI / 180}, {0.005, 10 * M_PI / 180}};

/// Along a wanted force of 3 N in any direction, without torque, in each pose.
std::vector<double> delivered_N(const Profile& profile, const Near& near) {
  Random random(1);
  TensionProblem problem;
  problem.count = profile.geometry.count;
  problem.t_min_N = problem.t_ref_N = profile.min_tension_N();
  problem.t_max_N = profile.max_tension_N();
  if (profile.geometry.grip_radius_m() > 0)
    problem.torque_length_m = profile.geometry.grip_radius_m();
  std::vector<double> forces_N;
  for (int n = 0; n < kPoses; ++n) {
    problem.W =
        structure_matrix(profile.geometry, random_pose(random, near.reach_m, near.turn_rad));
    const Eigen::Vector3d direction = random_direction(random);
    problem.wrench.force_N = kForce_N * direction;
    forces_N.push_back(TensionSolver().solve(problem).delivered.force_N.dot(direction));
  }
  return forces_N;
}

}  // namespace

int spidar::bench::workspace(int, char**) {
  std::printf(
      "force along a wanted 3 N, median (5 %% quantile) of %d poses\n\n"
      "| profile | ±2 cm, 20°, N | ±5 cm, 80°, N | ±5 mm, 10°, N |\n|---|---|---|---|\n",
      kPoses);
  for (const std::string& name : list_profiles()) {
    const Profile profile = load_profile(name);
    std::printf("| `%s` |", name.c_str());
    for (const Near& near : kNear) {
      const std::vector<double> forces_N = delivered_N(profile, near);
      std::printf(" %.2f (%.2f) |", quantile(forces_N, 0.5), quantile(forces_N, 0.05));
    }
    std::printf("\n");
  }
  return 0;
}
