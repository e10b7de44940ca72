// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/support/seam_watch.h"

#include "spidar/chain/brake_table.h"
#include "spidar/chain/tension_command.h"
#include "spidar/limits/wrench_limits.h"
#include "tests/support/test.h"

namespace spidar::test {
namespace {

/// Tensions become volts and are read back: a quotient and two products.
constexpr double kRounding_N = 1e-9;
/// The error of the speed that the brake sees.
constexpr double kSpeedError_m_s = brake::kSpeedError_m_s;
/// Of the bounds at rest, for a zero that is wrong.
constexpr double kZeroMargin = 1.1;

}  // namespace

SeamWatch::SeamWatch(const Profile& real)
    : real_(real), least_N_(real.min_tension_N()), most_N_(real.max_tension_N()) {}

double SeamWatch::force_N(const Pose& pose, const StringVector& tension_N) const {
  return (structure_matrix(real_.geometry, pose) * tension_N).head<3>().norm();
}

/// The brake ends a force at once and pushes against the motion. The power of the strings rises by
/// their pace at most, or to zero; and by what a wrong speed lets them push.
bool SeamWatch::never_pushes(const Tick& tick, double passed_s) const {
  Eigen::Matrix<double, 6, 1> motion;
  motion << tick.felt.velocity_m_s, tick.felt.angular_velocity_rad_s;
  const StructureMatrix W = structure_matrix(real_.geometry, tick.felt.pose);
  const double radius_m = real_.geometry.grip_radius_m();
  double paced_W = 0;
  for (int i = 0; i < real_.geometry.count; ++i) {
    const double pace_N_s = TensionSlew::pace_N_s(real_.drives[static_cast<size_t>(i)]);
    paced_W += passed_s * pace_N_s * std::abs(W.col(i).dot(motion));
  }
  const Eigen::Matrix<double, 6, 1> now = W * (tick.told_N - least_N_),
                                    before = W * (told_N_ - least_N_);
  const double wrong_W = kSpeedError_m_s * (now.head<3>().norm() + now.tail<3>().norm() / radius_m);
  return now.dot(motion) <= std::max(0.0, before.dot(motion)) + paced_W + wrong_W + kRounding_N;
}

void SeamWatch::check(const Tick& tick, const std::string& where) {
  const int count = real_.geometry.count;
  for (int i = 0; i < count; ++i) {
    const double told_N = tick.told_N[i];
    if (!(told_N >= -kRounding_N)) fail(tick, "a motor pushes", where);
    if (!(told_N <= most_N_[i] + kRounding_N)) fail(tick, "above the largest tension", where);
    if (!(told_N <= least_N_[i] + TensionCommand::kTensionPerForce * tick.size_N + kRounding_N))
      fail(tick, "more tension than the largest wrench is worth", where);
    if (tick.resting && !(told_N <= 3 * least_N_[i] + kRounding_N))
      fail(tick, "at rest above three times the least tension", where);
    if (tick.released && !(told_N <= kRounding_N)) fail(tick, "not off", where);
  }
  unanswered_s_ += tick.dt_s;
  if (tick.acknowledged) {
    // Falling values fall in the time since the last answer.
    const double passed_s = std::min(unanswered_s_, 2e-3);
    for (int i = 0; i < count; ++i) {
      const double step_N = std::abs(tick.told_N[i] - told_N_[i]);
      largest_.step_N = std::max(largest_.step_N, step_N);
      const StringDrive& drive = real_.drives[static_cast<size_t>(i)];
      const double step_s = tick.told_N[i] < told_N_[i] ? unanswered_s_ : passed_s;
      if (!tick.brakes && !(step_N <= step_s * TensionSlew::pace_N_s(drive) + kRounding_N))
        fail(tick, "a string changes too fast", where);
    }
    if (tick.brakes && tick.sees && !never_pushes(tick, passed_s))
      fail(tick, "the brake pushes the grip", where);
    told_N_ = tick.told_N;
    unanswered_s_ = 0;
  }

  const double force = force_N(tick.felt.pose, tick.told_N);
  if (tick.resting) {
    if (stopping_) largest_.stop_energy_J = std::max(largest_.stop_energy_J, stop_energy_J_);
    stopping_ = false;
    const double least = force_N(tick.felt.pose, least_N_);
    ++largest_.resting_ticks;
    largest_.resting_force_N = std::max(largest_.resting_force_N, force);
    largest_.resting_excess = std::max(largest_.resting_excess, force - least);
    if (!(force <= kZeroMargin * least + kRounding_N))
      fail(tick, "at rest more force than the least tensions give", where);
    return;
  }
  ++largest_.playing_ticks;
  largest_.playing_force_N = std::max(largest_.playing_force_N, force);
  stop_energy_J_ +=
      tick.dt_s *
      std::max(0.0, tick.felt.wrench.force_N.dot(tick.felt.velocity_m_s) +
                        tick.felt.wrench.torque_Nm.dot(tick.felt.angular_velocity_rad_s));
}

void SeamWatch::fail(const Tick& tick, const std::string& what, const std::string& where) {
  if (failed_) return;
  failed_ = true;
  std::ostringstream text;
  text << what << " (" << where << ")\n  told, N:     " << tick.told_N.transpose()
       << "\n  last, N:     " << told_N_.transpose() << "\n  least, N:    " << least_N_.transpose()
       << "\n  resting " << tick.resting << ", acknowledged " << tick.acknowledged << ", grip at "
       << tick.felt.pose.position_m.transpose() << " m";
  ADD_FAILURE() << text.str();
}

}  // namespace spidar::test
