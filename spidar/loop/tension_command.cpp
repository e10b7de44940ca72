// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/loop/tension_command.h"

#include <algorithm>
#include <cmath>

namespace spidar {
namespace {

/// The largest s ≤ 1 with |from + s step| ≤ most, or ≤ |from| where that is larger.
double longest_step(const Eigen::Vector3d& from, const Eigen::Vector3d& step, double most) {
  const double length2 = step.squaredNorm();
  if (!(length2 > 0)) return 1;
  const double room2 = most > 0 ? std::max(0.0, most * most - from.squaredNorm()) : 0;
  const double towards = -from.dot(step);
  const double s = (towards + std::sqrt(towards * towards + length2 * room2)) / length2;
  return std::clamp(s, 0.0, 1.0);
}

}  // namespace

TensionCommand::TensionCommand(const Profile& profile)
    : min_N_(profile.min_tension_N()),
      max_N_(profile.max_tension_N()),
      rest_N_(min_N_),
      last_N_(min_N_) {
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
                                   const StringVector& limit_N) noexcept {
  share_ = 1;
  const double size = last_size_N_ = size_N(wrench);
  rest_N_ = last_N_ = min_N_;
  if (!(size > 0)) return last_N_;
  problem_.W = W;
  const Eigen::Matrix<double, 6, 1> rest = (left_out_ < 0 ? 1 : 0) * (W * min_N_);
  const Wrench at_rest{rest.head<3>(), rest.tail<3>()};
  // Half of the range counts as all of it: that is at most what a motor may sustain for ever.
  const double denied = std::min(1.0, 2 * pose_problem(wrench, limit_N));
  problem_.wrench = problem_.wrench + at_rest;
  TensionResult result = solver_.solve(problem_);
  if (denied > 0) {
    share_ = std::max(0.0, 1 - denied * result.residual_N / size);
    // The string that is left out does not get its tension back with the smaller wrench: it may be
    // broken.
    const double left_out_N = left_out_ < 0 ? 0 : problem_.t_ref_N[left_out_];
    pose_problem(share_ * wrench, limit_N);
    if (left_out_ >= 0) {
      problem_.t_min_N[left_out_] = problem_.t_max_N[left_out_] = problem_.t_ref_N[left_out_] =
          left_out_N;
    }
    problem_.wrench = problem_.wrench + at_rest;
    result = solver_.solve(problem_);
  }
  last_N_ = result.tension_N;
  if (left_out_ >= 0) rest_N_[left_out_] = last_N_[left_out_];
  return last_N_;
}

double TensionCommand::share_within(const StructureMatrix& W,
                                    const SafetyLimits& limits) const noexcept {
  const Eigen::Vector3d rest_N = W.topRows<3>() * rest_N_;
  const Eigen::Vector3d added_N = W.topRows<3>() * (last_N_ - rest_N_);
  return longest_step(rest_N, added_N, limits.max_force_N);
}

StringVector TensionCommand::reduce(double share) noexcept {
  if (share < 1) last_N_ = rest_N_ + share * (last_N_ - rest_N_);
  return last_N_;
}

StringVector TensionCommand::fade(const Wrench& wrench) noexcept {
  share_ = 1;
  if (!(last_size_N_ > 0)) return min_N_;
  return min_N_ + std::min(1.0, size_N(wrench) / last_size_N_) * (last_N_ - min_N_);
}

}  // namespace spidar
