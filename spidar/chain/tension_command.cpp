// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/chain/tension_command.h"

#include <cmath>

namespace spidar {

StringVector TensionSlew::apply(const StringVector& tension_N, const Profile& profile,
                                double dt_s) noexcept {
  StringVector wanted_N = tension_N;
  double fraction = 1;
  for (int i = 0; i < profile.geometry.count; ++i) {
    const StringDrive& drive = profile.drives[static_cast<size_t>(i)];
    if (!std::isfinite(wanted_N[i])) wanted_N[i] = drive.min_tension_N;
    const double allowed_N = non_negative(dt_s) * pace_N_s(drive);
    const double change_N = std::fabs(wanted_N[i] - last_N_[i]);
    if (change_N > allowed_N) fraction = std::min(fraction, allowed_N / change_N);
  }
  last_N_ = fraction < 1 ? StringVector(last_N_ + fraction * (wanted_N - last_N_)) : wanted_N;
  return last_N_;
}

StringVector bound_tensions(const StringVector& tension_N, const Profile& profile) noexcept {
  StringVector bounded = StringVector::Zero();
  for (int i = 0; i < profile.geometry.count; ++i) {
    bounded[i] =
        std::min(non_negative(tension_N[i]), profile.drives[static_cast<size_t>(i)].max_tension_N);
  }
  return bounded;
}

MotorVolts to_volts(const StringVector& tension_N, const Profile& profile) noexcept {
  MotorVolts volts;
  for (int i = 0; i < profile.geometry.count; ++i) {
    const auto k = static_cast<size_t>(i);
    const StringDrive& drive = profile.drives[k];
    const double magnitude = non_negative(tension_N[i] / drive.newtons_per_volt);
    volts.volt[k] = drive.motor_sign * std::min(magnitude, profile.dac_max_V);
  }
  return volts;
}

namespace {

/// Returns the largest s ≤ 1 with |from + s step| ≤ most, or ≤ |from| where that is larger.
double longest_step(const Eigen::Vector3d& from, const Eigen::Vector3d& step, double most) {
  const double length2 = step.squaredNorm();
  if (!(length2 > 0)) return 1;
  const double room2 = most > 0 ? std::max(0.0, most * most - from.squaredNorm()) : 0;
  const double towards = -from.dot(step);
  const double s = (towards + std::sqrt(towards * towards + length2 * room2)) / length2;
  return std::clamp(s, 0.0, 1.0);
}

Wrench wrench_of(const StructureMatrix& W, const StringVector& tension_N) {
  const Eigen::Matrix<double, 6, 1> wrench = W * tension_N;
  return {wrench.head<3>(), wrench.tail<3>()};
}

}  // namespace

TensionCommand::TensionCommand(const Profile& profile)
    : geometry_(profile.geometry),
      ahead_s_(kAhead_s + 2 * profile.drive_lag_s),
      min_N_(profile.min_tension_N()),
      max_N_(profile.max_tension_N()),
      last_N_(min_N_) {
  const int count = problem_.count = profile.geometry.count;
  shortest_m_ = string_lengths_m(geometry_, {}).head(count).minCoeff();
  for (int i = 0; i < count; ++i) {
    reach_m_ = std::max(reach_m_, geometry_.grip_m[static_cast<size_t>(i)].norm());
  }
  const double radius_m = profile.geometry.grip_radius_m();
  // A grip of zero radius transmits no torque, so the length that weights torque does not matter.
  if (radius_m > 0) problem_.torque_length_m = radius_m;
  reset();
}

void TensionCommand::reset() noexcept {
  solver_.reset();
  last_N_ = min_N_;
  last_size_N_ = 0;
  fraction_ = 1;
  left_out_ = -1;
  fades_ = true;
}

double TensionCommand::pose_problem(const Wrench& wrench, const StringVector& limit_N) noexcept {
  problem_.wrench = wrench;
  problem_.t_min_N = problem_.t_ref_N = min_N_;
  const double above_N = kTensionPerForce * size_N(wrench, problem_.torque_length_m);
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
// direction. The wanted wrench is therefore reduced to the fraction that can be produced. This
// fraction varies continuously with pose, wrench and limits.
StringVector TensionCommand::solve(const StructureMatrix& W, const Wrench& wrench,
                                   const StringVector& limit_N) noexcept {
  fraction_ = 1;
  const double size = last_size_N_ = size_N(wrench, problem_.torque_length_m);
  last_N_ = min_N_;
  fades_ = false;
  if (!(size > 0)) return last_N_;
  problem_.W = W;
  const Wrench at_rest = left_out_ < 0 ? wrench_of(W, min_N_) : Wrench();
  // A string that may use half of its range counts as not limited, because some motors sustain no
  // more indefinitely.
  const double denied = std::min(1.0, 2 * pose_problem(wrench, limit_N));
  problem_.wrench = problem_.wrench + at_rest;
  TensionResult result = solver_.solve(problem_);
  if (denied > 0) {
    fraction_ = std::max(0.0, 1 - denied * result.residual_N / size);
    pose_problem(fraction_ * wrench, limit_N);
    problem_.wrench = problem_.wrench + at_rest;
    result = solver_.solve(problem_);
  }
  last_N_ = result.tension_N;
  return last_N_;
}

double TensionCommand::stray_Nm(const SafetyLimits& limits) const noexcept {
  return kStrayLever * problem_.torque_length_m * limits.max_force_N;
}

double TensionCommand::fraction_within(const StructureMatrix& W,
                                       const SafetyLimits& limits) const noexcept {
  const Wrench whole = wrench_of(W, last_N_);
  const Wrench rest = wrench_of(W, min_N_);
  const Wrench added = whole - rest;
  const double max_torque_Nm =
      std::max(limits.max_torque_Nm, rest.torque_Nm.norm() + stray_Nm(limits));
  return std::min(longest_step(rest.force_N, added.force_N, limits.max_force_N),
                  longest_step(rest.torque_Nm, added.torque_Nm, max_torque_Nm));
}

// A point that moves by w turns a string of length L by w / (L − w) at most. For each newton of a
// string, the force changes by this angle; the torque changes by this angle times the arm, plus the
// motion of the arm's end.
bool TensionCommand::stays_within(const StructureMatrix& W, const SafetyLimits& limits,
                                  const Pose& pose, double moved_m) const noexcept {
  // A point at r is moved by 2 r sin(θ/2) when the grip turns by θ.
  const double off_m = pose.position_m.norm() + 2 * reach_m_ * pose.orientation.vec().norm();
  const double length_m = shortest_m_ - off_m - moved_m;
  if (!(length_m > 0)) return false;
  const double turn = moved_m / length_m;
  const double sum_N = last_N_.sum();
  const Wrench now = wrench_of(W, last_N_);
  return now.force_N.norm() + turn * sum_N <= limits.max_force_N &&
         now.torque_Nm.norm() + (reach_m_ * turn + moved_m) * sum_N <=
             std::max(limits.max_torque_Nm, stray_Nm(limits));
}

StringVector TensionCommand::limit(const StructureMatrix& W, const SafetyLimits& limits,
                                   const Pose& pose, const GripMotion& motion) noexcept {
  if (!(last_size_N_ > 0)) return last_N_;
  const GripVelocity& now = motion.velocity();
  const double moved_m = ahead_s_ * (now.linear_m_s.norm() + reach_m_ * now.angular_rad_s.norm());
  if (stays_within(W, limits, pose, moved_m)) return last_N_;
  const StructureMatrix there = structure_matrix(geometry_, motion.pose_in(pose, ahead_s_));
  // The structure matrix changes little on the way, so both ends bound the wrench between them.
  const double fraction = std::min(fraction_within(W, limits), fraction_within(there, limits));
  if (fraction < 1) last_N_ = min_N_ + fraction * (last_N_ - min_N_);
  return last_N_;
}

StringVector TensionCommand::fade(const Wrench& wrench, double pace) noexcept {
  fraction_ = 1;
  if (!(last_size_N_ > 0)) return min_N_;
  const double gone = 1 - size_N(wrench, problem_.torque_length_m) / last_size_N_;
  return min_N_ + std::clamp(1 - pace * gone, 0.0, 1.0) * (last_N_ - min_N_);
}

}  // namespace spidar
