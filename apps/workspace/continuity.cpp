// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "apps/workspace/continuity.h"

#include <algorithm>
#include <cstdio>
#include <random>
#include <stdexcept>

#include "apps/workspace/delivery.h"
#include "core/grip/tension_solver.h"
#include "core/quantile.h"
#include "tests/support/grip_path.h"
#include "tests/support/tension_step.h"

namespace {

using spidar::quantile;

using spidar::test::GripPath;
using spidar::test::PathLimits;
using spidar::test::TensionStep;

constexpr double kTick_s = 0.001;
constexpr int kTicks = 1000;  // of each path
constexpr unsigned kPaths = 20;

const PathLimits kPathKinds[] = {PathLimits(), spidar::test::far_and_turned()};

/// Smaller paths for small devices: half of the shortest string for translation and a quarter for
/// rotation, because a string of almost no length reverses its direction suddenly.
PathLimits fitted(PathLimits limits, const spidar::Profile& profile) {
  const spidar::StringGeometry& geometry = profile.geometry;
  const double shortest_m = string_lengths_m(geometry, {}).head(geometry.count).minCoeff();
  limits.reach_m = std::min(limits.reach_m, shortest_m / 2);
  limits.angle_rad = std::min(limits.angle_rad, shortest_m / 4 / geometry.grip_radius_m());
  return limits;
}

struct Walk {
  std::vector<double> steps_N;      ///< of the string that changed most, in each tick
  std::vector<double> residuals_N;  ///< ‖S(W t − f)‖, in each tick
  TensionStep largest;
};

void follow(const GripPath& path, const spidar::StringGeometry& geometry,
            spidar::TensionProblem problem, Walk& sum) {
  spidar::TensionSolver solver;
  spidar::TensionProblem last;
  spidar::StringVector last_N;
  for (int tick = 0; tick <= kTicks; ++tick) {
    problem.W = structure_matrix(geometry, path.pose(tick * kTick_s));
    problem.wrench = path.wrench(tick * kTick_s);
    const spidar::TensionResult result = solver.solve(problem);
    if (result.status != spidar::TensionStatus::kSolved)
      throw std::runtime_error("the tension solver did not reach a solution");
    if (tick > 0) {
      const TensionStep step = spidar::test::tension_step(last, last_N, problem, result.tension_N);
      sum.steps_N.push_back(step.largest_N);
      sum.residuals_N.push_back(result.residual_N);
      if (step.largest_N > sum.largest.largest_N) sum.largest = step;
    }
    last = problem;
    last_N = result.tension_N;
  }
}

Walk walk(const spidar::Profile& profile, const Weights& weights, const PathLimits& limits) {
  Walk sum;
  for (unsigned seed = 1; seed <= kPaths; ++seed) {
    std::mt19937_64 random(seed);
    const GripPath path(random, fitted(limits, profile));
    follow(path, profile.geometry, tension_problem(profile, weights), sum);
  }
  return sum;
}

}  // namespace

void print_continuity(const std::vector<spidar::Profile>& profiles) {
  std::printf(
      "| profile | near: median | 99 %% | largest | its bound, piecewise | Lipschitz "
      "| far: median | 99 %% | largest | its bound, piecewise | Lipschitz |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const spidar::Profile& profile : profiles) {
    std::printf("| `%s` |", profile.name.c_str());
    for (const PathLimits& limits : kPathKinds) {
      Walk sum = walk(profile, loop_weights(profile), limits);
      std::printf(" %.3f | %.2f | %.2f | %.2f | %.1f |", quantile(sum.steps_N, 0.5),
                  quantile(sum.steps_N, 0.99), sum.largest.largest_N, sum.largest.piecewise_N,
                  sum.largest.lipschitz_N);
    }
    std::printf("\n");
  }
}

void print_smoothing(const spidar::Profile& profile) {
  std::printf(
      "| ε | near: missing, N: median | 95 %% | step, N: median | 99 %% | largest "
      "| far: missing, N: median | 95 %% | step, N: median | 99 %% | largest |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const double epsilon : {1e-5, 1e-4, 1e-3, 1e-2, 1e-1, 0.3}) {
    Weights weights = loop_weights(profile);
    weights.epsilon = epsilon;
    std::printf("| %g |", epsilon);
    for (const PathLimits& limits : kPathKinds) {
      Walk sum = walk(profile, weights, limits);
      std::printf(" %.4f | %.4f | %.3f | %.2f | %.2f |", quantile(sum.residuals_N, 0.5),
                  quantile(sum.residuals_N, 0.95), quantile(sum.steps_N, 0.5),
                  quantile(sum.steps_N, 0.99), sum.largest.largest_N);
    }
    std::printf("\n");
  }
}
