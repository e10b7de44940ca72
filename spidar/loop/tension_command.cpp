// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/loop/tension_command.h"

#include <algorithm>
#include <cmath>

namespace spidar {

TensionCommand::TensionCommand(const Profile& profile)
    : min_N_(profile.min_tension_N()), max_N_(profile.max_tension_N()), last_N_(min_N_) {
  problem_.count = profile.geometry.count;
  const double radius_m = profile.geometry.grip_radius_m();
  // A grip of zero radius cannot transmit torque, so the length that weights torque does not
  // matter.
  if (radius_m > 0) problem_.torque_length_m = radius_m;
  reset();
}

void TensionCommand::reset() noexcept {
  solver_.reset();
  last_N_ = min_N_;
  last_size_N_ = 0;
  share_ = 1;
  left_out_ = -1;
}

double TensionCommand::size_N(const Wrench& wrench) const noexcept {
  return std::hypot(wrench.force_N.norm(), wrench.torque_Nm.norm() / problem_.torque_length_m);
}

double TensionCommand::pose_problem(const Wrench& wrench, const StringVector& limit_N) noexcept {
  problem_.wrench = wrench;
  problem_.t_min_N = problem_.t_ref_N = min_N_;
  const double above_N = kTensionPerForce * size_N(wrench);
  double denied = 0;
  for (int i = 0; i < problem_.count; ++i) {
    const double allowed_N = std::clamp(limit_N[i], min_N_[i], max_N_[i]);
    problem_.t_max_N[i] = std::min(min_N_[i] + above_N, allowed_N);
    denied = std::max(denied, 1 - allowed_N / max_N_[i]);
  }
  if (left_out_ < 0) return denied;
  problem_.t_min_N[left_out_] = problem_.t_max_N[left_out_] = problem_.t_ref_N[left_out_] =
      std::max(0.0, min_N_[left_out_] - above_N);
  return 1;
}

// When some strings may not use their full range, the others would produce a wrench in another
// direction. The wanted wrench is therefore reduced to the share that can be produced. This share
// varies continuously with pose, wrench and limits.
StringVector TensionCommand::solve(const StructureMatrix& W, const Wrench& wrench,
                                   const StringVector& limit_N, double kept) noexcept {
  share_ = 1;
  const double size = last_size_N_ = size_N(wrench);
  last_N_ = min_N_;
  if (!(size > 0)) return last_N_;
  problem_.W = W;
  const Eigen::Matrix<double, 6, 1> rest = (left_out_ < 0 ? kept : 0) * (W * min_N_);
  const Wrench at_rest{rest.head<3>(), rest.tail<3>()};
  // Half of the range counts as all of it: that is at most what a motor may sustain for ever.
  const double denied = std::min(1.0, 2 * pose_problem(wrench, limit_N));
  problem_.wrench = problem_.wrench + at_rest;
  TensionResult result = solver_.solve(problem_);
  if (denied > 0) {
    share_ = std::max(0.0, 1 - denied * result.residual_N / size);
    pose_problem(share_ * wrench, limit_N);
    problem_.wrench = problem_.wrench + at_rest;
    result = solver_.solve(problem_);
  }
  last_N_ = result.tension_N;
  return last_N_;
}

StringVector TensionCommand::fade(const Wrench& wrench) noexcept {
  share_ = 1;
  if (!(last_size_N_ > 0)) return min_N_;
  return min_N_ + std::min(1.0, size_N(wrench) / last_size_N_) * (last_N_ - min_N_);
}

}  // namespace spidar
