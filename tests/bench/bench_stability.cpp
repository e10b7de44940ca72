// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Numerical stability of poses, by the condition number of the structure matrix there, from 1 mm
/// and 0.02 rad away; and of the solved ones, the force along a wanted 3 N (median), and by how
/// much it differs from that at the right pose. That of the tension solver is `spidar-bench
/// tension`.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include <Eigen/SVD>

#include "core/grip/pose_solver.h"
#include "core/grip/tension_solver.h"
#include "spidar/profiles/profile.h"
#include "tests/bench/benchmarks.h"
#include "tests/bench/call_timer.h"
#include "tests/support/random_motion.h"

namespace {

using namespace spidar;
using Eigen::Vector3d;

constexpr int kCases = 2000;

/// The force that the strings give at a pose when another one is believed, without torque; where
/// both are the same, the wanted one as far as the profile's tensions reach.
Vector3d felt_N(const Profile& profile, const Pose& pose, const Pose& believed,
                const Vector3d& wanted_N) {
  TensionProblem problem;
  problem.count = profile.geometry.count;
  problem.t_min_N = problem.t_ref_N = profile.min_tension_N();
  problem.t_max_N = profile.max_tension_N();
  if (profile.geometry.grip_radius_m() > 0)
    problem.torque_length_m = profile.geometry.grip_radius_m();
  problem.W = structure_matrix(profile.geometry, believed);
  problem.wrench.force_N = wanted_N;
  const StringVector tension_N = TensionSolver().solve(problem).tension_N;
  return structure_matrix(profile.geometry, pose).topRows<3>() * tension_N;
}

/// Poses of all profiles, from 1 mm away, and more of those beyond a condition number of 100 until
/// there are kCases of them.
void print_poses() {
  constexpr double kHard = 100, kForce_N = 3;
  struct Bin {
    int cases = 0, wrong = 0;
    std::vector<double> error_m, along_N, off_N;
  };
  std::map<int, Bin> bins;  // by the decimal logarithm of the condition number, halves
  const std::vector<std::string> names = list_profiles();
  for (const std::string& name : names) {
    const Profile profile = load_profile(name);
    PoseSolver solver(profile.geometry);
    test::RandomMotion random(3);
    double reach_m = 0;
    for (int i = 0; i < profile.geometry.count; ++i)
      reach_m = std::max(reach_m, profile.geometry.exit_m[static_cast<size_t>(i)].norm());
    int hard = 0;
    constexpr int kMaxTried = 200 * kCases;
    for (int n = 0; n < kMaxTried && (n < kCases || hard * names.size() < kCases); ++n) {
      const Pose pose = random.pose(0.9 * reach_m, 1.2);
      StructureMatrix W = structure_matrix(profile.geometry, pose);
      W.bottomRows<3>() /= profile.geometry.grip_radius_m();
      const auto values = W.leftCols(profile.geometry.count).eval().jacobiSvd().singularValues();
      const bool is_hard = values[0] > kHard * values[5];
      hard += is_hard;
      if (n >= kCases && !is_hard) continue;
      Bin& bin = bins[static_cast<int>(std::floor(2 * std::log10(values[0] / values[5])))];
      Pose begin = pose;
      begin.position_m += 1e-3 * random.direction();
      begin.orientation = Eigen::AngleAxisd(0.02, random.direction()) * begin.orientation;
      solver.reset(begin);
      const PoseResult found = solver.track(string_lengths_m(profile.geometry, pose));
      ++bin.cases;
      if (found.status != PoseStatus::kSolved) continue;
      bin.error_m.push_back((found.pose.position_m - pose.position_m).norm());
      bin.wrong += !(bin.error_m.back() < 1e-6);
      const Vector3d wanted_N = kForce_N * random.direction();
      const Vector3d given_N = felt_N(profile, pose, pose, wanted_N);
      bin.along_N.push_back(given_N.dot(wanted_N) / kForce_N);
      bin.off_N.push_back((felt_N(profile, pose, found.pose, wanted_N) - given_N).norm());
    }
  }
  std::printf(
      "| poses, condition number | cases | solved | wrong by more than 1 µm | worst, m | along a "
      "wanted 3 N, N | off by, 99 %%, N | at most |\n|---|---|---|---|---|---|---|---|\n");
  for (const auto& [half, bin] : bins) {
    if (bin.error_m.empty()) continue;
    std::printf("| %.0e to %.0e | %d | %.1f %% | %d | %.1e | %.2f | %.3f | %.2f |\n",
                std::pow(10, half / 2.0), std::pow(10, (half + 1) / 2.0), bin.cases,
                100.0 * static_cast<double>(bin.error_m.size()) / bin.cases, bin.wrong,
                bench::quantile(bin.error_m, 1), bench::quantile(bin.along_N, 0.5),
                bench::quantile(bin.off_N, 0.99), bench::quantile(bin.off_N, 1));
  }
}

}  // namespace

int spidar::bench::stability(int, char**) {
  print_poses();
  return 0;
}
