// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/touch/energy_budget.h"

#include <algorithm>
#include <cmath>

namespace spidar::touch {
namespace {

Eigen::Vector3d bounded(const Eigen::Vector3d& vector, double most) noexcept {
  const double length = vector.norm();
  return length > most ? Eigen::Vector3d(vector * (most / length)) : vector;
}

}  // namespace

void EnergyBudget::update(const Eigen::Vector3d& moved_m, const Eigen::Vector3d& velocity_m_s,
                          double added_J, double stored_J) noexcept {
  left_J_ = std::min(left_J_ - before_N_.dot(moved_m) + added_J, stored_J);
  velocity_m_s_.add(velocity_m_s);
}

double EnergyBudget::allowed_force_N(const Eigen::Vector3d& direction, const ForcePath& path,
                                     double dt_s) const noexcept {
  // The grip is at rest before the first tick.
  const auto velocity_m_s = [this](size_t age) -> Eigen::Vector3d {
    return age < velocity_m_s_.size() ? velocity_m_s_[age] : Eigen::Vector3d::Zero();
  };
  // Half a tick less than kSlope ticks, because a rounding error must not add a tick.
  const double least_s = (kSlope - 0.5) * path.tick_s;
  double passed_s = 0;
  size_t since = 0;
  for (; since < kKept && (since < kSlope || passed_s < least_s); ++since) {
    passed_s += since < dt_s_.size() ? dt_s_[since] : path.tick_s;
  }
  passed_s = std::max(passed_s, least_s);
  const Eigen::Vector3d gained_m_s = velocity_m_s(0) - velocity_m_s(since);
  const Eigen::Vector3d then_m_s = velocity_m_s(0) + gained_m_s * (path.velocity_lag_s / passed_s);
  // The work of the last tick is not in left_J_ yet.
  const double left_J = std::max(0.0, left_J_ - dt_s * mean_.force_N.dot(then_m_s));
  // The delivered force may drive a motion that the wanted force brakes.
  const double out_m_s = then_m_s.dot(direction);
  const double out_if_given_m_s = given_ ? then_m_s.dot(*given_) : out_m_s;
  const double most_m_s = std::max(out_m_s, out_if_given_m_s);
  // Solves v J + J² / (2 m) = energy for the impulse J, and J for the force F.
  const double mass_kg = path.least_mass_kg;
  const double whole_Ns =
      mass_kg * (std::sqrt(most_m_s * most_m_s + 2 * left_J / mass_kg) - most_m_s);
  const double impulse_Ns = whole_Ns - path.lag_s * std::max(0.0, acting_.force_N.dot(direction));
  if (!(impulse_Ns > 0)) return 0;
  const double slew_N_s = path.max_slew_N_s;
  const double tick_s = path.tick_s;
  return slew_N_s * (std::sqrt(tick_s * tick_s + 2 * impulse_Ns / slew_N_s) - tick_s);
}

/// When little energy is left, the bound follows the noise of the velocity. The force would be
/// smoother if it rose more slowly than the slew limit, but it would then absorb too little energy
/// while the grip moves in, and stay low.
double EnergyBudget::allowed_fraction(const Eigen::Vector3d& wanted_N, const ForcePath& path,
                                      double dt_s) noexcept {
  constexpr double kUnbounded_N = std::numeric_limits<double>::infinity();
  const double size_N = wanted_N.norm();
  if (!(size_N > 0)) {
    bounded_N_ = kUnbounded_N;
    return 1;
  }
  const double back_N = bounded_N_ + path.max_slew_N_s * std::min(dt_s, path.longest_tick_s);
  const double allowed_N = std::min(back_N, allowed_force_N(wanted_N / size_N, path, dt_s));
  bounded_N_ = allowed_N < size_N ? allowed_N : kUnbounded_N;
  return std::min(1.0, allowed_N / size_N);
}

void EnergyBudget::command(const Eigen::Vector3d& wanted_N, const Eigen::Vector3d& beside_N,
                           const ForcePath& path, double dt_s) noexcept {
  const auto follow = [&](const Eigen::Vector3d& to_N, Eigen::Vector3d& limited_N) {
    const Eigen::Vector3d change_N = bounded(to_N, path.max_force_N) - limited_N;
    limited_N += bounded(change_N, path.max_slew_N_s * std::min(dt_s, path.longest_tick_s));
  };
  follow(wanted_N + beside_N, limited_N_);
  follow(beside_N, beside_N_);
  dt_s_.add(dt_s);
  given_.reset();
  begun_ = acting_;
  before_N_ = mean_.force_N;
  // Response of a first-order lag to a force that is held for one tick.
  fading_ = path.lag_s > 0 ? std::exp(-path.tick_s / path.lag_s) : 0;
  lag_ticks_ = path.lag_s / path.tick_s;
  turned_Nm_ = mean_.torque_Nm;
  apply_lag({limited_N_ - beside_N_, Eigen::Vector3d::Zero()});
}

/// Computes the force on the grip when the drives follow `own` from begun_ with their lag.
void EnergyBudget::apply_lag(const Wrench& own) noexcept {
  const Wrench behind = begun_ - own;
  mean_ = own + (1 - fading_) * lag_ticks_ * behind;
  acting_ = own + fading_ * behind;
}

void EnergyBudget::set_delivered(const Wrench& given, const Eigen::Vector3d& turn_rad) noexcept {
  left_J_ -= turned_Nm_.dot(turn_rad);
  const double size_N = limited_N_.norm();
  if (!(size_N > 0) || !beside_N_.isZero(0)) return;
  if (size_N > kKnownDirection_N) given_ = given.force_N / size_N;
  apply_lag(given);
}

}  // namespace spidar::touch
