// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "apps/workspace/delivery.h"

#include <cmath>
#include <stdexcept>

Weights loop_weights(const spidar::Profile& profile) {
  Weights weights;
  const double radius_m = profile.geometry.grip_radius_m();
  if (radius_m > 0) weights.torque_length_m = radius_m;
  weights.t_ref_N = profile.min_tension_N();
  return weights;
}

Weights published_weights() {
  Weights weights;
  weights.epsilon = 0.3;
  weights.torque_length_m = 1 / std::sqrt(6.0);
  return weights;
}

spidar::TensionProblem tension_problem(const spidar::Profile& profile, const Weights& weights) {
  spidar::TensionProblem problem;
  problem.count = profile.geometry.count;
  problem.t_min_N = profile.min_tension_N();
  problem.t_max_N = profile.max_tension_N();
  problem.t_ref_N = weights.t_ref_N;
  problem.epsilon = weights.epsilon;
  problem.torque_length_m = weights.torque_length_m;
  return problem;
}

std::vector<Eigen::Vector3d> even_directions(int count) {
  const double golden_angle = M_PI * (3 - std::sqrt(5.0));
  std::vector<Eigen::Vector3d> directions;
  for (int i = 0; i < count; ++i) {
    const double z = 1 - (2 * i + 1.0) / count;
    const double radius = std::sqrt(1 - z * z);
    directions.emplace_back(radius * std::cos(i * golden_angle),
                            radius * std::sin(i * golden_angle), z);
  }
  return directions;
}

spidar::TensionResult Deliverer::solve(const Eigen::Vector3d& direction) {
  problem_.wrench = {kWanted_N * direction, Eigen::Vector3d::Zero()};
  const spidar::TensionResult result = solver_.solve(problem_);
  if (result.status != spidar::TensionStatus::kSolved)
    throw std::runtime_error("the tension solver did not reach a solution");
  return result;
}

Delivery Deliverer::deliver(const Eigen::Vector3d& direction) {
  const spidar::Wrench delivered = solve(direction).delivered;
  return {delivered.force_N.dot(direction), delivered.torque_Nm.norm()};
}

bool Deliverer::delivers_exactly(const Eigen::Vector3d& direction) {
  return solve(direction).residual_N <=
         std::sqrt(problem_.epsilon) * (problem_.t_max_N - problem_.t_min_N).norm();
}
