// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/chain/grip_brake.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace spidar {
namespace {

using namespace brake;

/// The fraction of a force that remains at `speed_m_s` in the band.
double left_at(double speed_m_s, const FadeBand& band) {
  return std::clamp((band.to_m_s - speed_m_s) / (band.to_m_s - band.from_m_s), 0.0, 1.0);
}

/// Reduces the component of `vector` along `along`, unless it is against it, to `left` of it.
Eigen::Vector3d faded(const Eigen::Vector3d& vector, const Eigen::Vector3d& along, double left) {
  if (left >= 1) return vector;
  return vector - (1 - left) * std::max(0.0, vector.dot(along)) / along.squaredNorm() * along;
}

/// The force or torque that damps the part of `velocity` above the lower speed of the band. The
/// speed of a rotation is that of the end of an arm of `arm_m`; for a displacement, `arm_m` is 1.
/// `damping` is in N s/m or N m s/rad.
Eigen::Vector3d damped(const Eigen::Vector3d& velocity, double arm_m, const FadeBand& band,
                       double damping) {
  const double speed_m_s = arm_m * velocity.norm();
  const double above_m_s = speed_m_s - band.from_m_s;
  if (!(above_m_s > 0)) return Eigen::Vector3d::Zero();
  return -damping * above_m_s / speed_m_s * velocity;
}

/// Rises from 0 to 1 while `fraction` rises from a half to 1.
double upper_half(double fraction) {
  return std::clamp(2 * fraction - 1, 0.0, 1.0);
}

/// Reduces `vector` to the fraction `left`, except for its component against `velocity`.
Eigen::Vector3d without_push(const Eigen::Vector3d& vector, const Eigen::Vector3d& velocity,
                             double left) {
  if (left >= 1) return vector;
  const Eigen::Vector3d braking =
      std::min(0.0, vector.dot(velocity)) / velocity.squaredNorm() * velocity;
  return braking + left * (vector - braking);
}

}  // namespace

void GripBrake::reset() noexcept {
  strings_N_.setZero();
  film_N_.setZero();
  acting_N_.setZero();
  away_m_.setZero();
  work_J_ = fast_s_ = 0;
  if (!held()) release();
}

void GripBrake::pull(const Eigen::Vector3d& strings_N, const Eigen::Vector3d& at_rest_N,
                     double dt_s) noexcept {
  // The previous command has acted until now.
  acting_N_ += fraction_passed(dt_s, drive_lag_s_) * (strings_N_ - acting_N_);
  strings_N_ = strings_N;
  film_N_ = strings_N - at_rest_N;
}

void GripBrake::update(const Eigen::Vector3d& position_m, const GripMotion& motion, double stored_J,
                       double dt_s) noexcept {
  const Eigen::Vector3d& velocity_m_s = motion.velocity().linear_m_s;
  stored_J_ = stored_J;
  if (!std::exchange(knows_place_, true)) place_m_ = position_m;
  away_m_ = position_m - place_m_;
  // The place does not follow a grip that the force pushes away: no hand chose that position.
  if (!(film_N_.dot(away_m_) > 0)) place_m_ += fraction_passed(dt_s, kFollows_s) * away_m_;
  // A braked grip keeps what it was given: a hand's spring may return it. No unheld grip has more
  // energy than the heaviest at its speed.
  const double speed_m_s =
      kSpeedError_m_s + std::max(velocity_m_s.norm(), ahead_.linear_m_s.norm());
  work_J_ = std::min(work_J_ + std::max(0.0, dt_s * acting_N_.dot(velocity_m_s)),
                     0.5 * kHeaviestGrip_kg * speed_m_s * speed_m_s);
}

/// A grip that rotates to and fro is slow twice in each period, so slow ticks count half.
void GripBrake::rest_or_return(const GripVelocity& velocity, double dt_s) noexcept {
  const bool is_fast = velocity.linear_m_s.norm() > by_work(kFadeFrom_m_s, kHeavyFrom_m_s) ||
                       body_.surface_m * velocity.angular_rad_s.norm() > kFadeFrom_m_s;
  fast_s_ = std::clamp(fast_s_ + (is_fast ? dt_s : -dt_s / 2), 0.0, kFast_s);
  if (fast_s_ >= kFast_s) release();
  resting_s_ = std::max(0.0, resting_s_ - dt_s);
  fraction_ = resting_s_ > 0 ? 0 : std::min(1.0, fraction_ + dt_s / kReturn_s);
}

/// From `light` to `heavy`, the more work the strings have done.
double GripBrake::by_work(double light, double heavy) const noexcept {
  return light + upper_half(work_J_ / kHeavyWork_J) * (heavy - light);
}

/// The damping of the speed above the FadeBand. If the strings have given less energy than the
/// lightest grip has at this speed, a hand moves the grip and must not feel the damper.
double GripBrake::damping_N_s_m(double speed_m_s) const noexcept {
  if (!held()) return kDamping_N_s_m;
  const double least_m_s = std::max(speed_m_s - kSpeedError_m_s, 1e-3);
  return kDamping_N_s_m * upper_half(2 * work_J_ / (kLightestGrip_kg * least_m_s * least_m_s));
}

/// The largest energy of the rotation and the energy that the strings at rest have stored are
/// subtracted from kReleased_J, and the speeds are lower accordingly. Otherwise a film would push a
/// heavy grip to where no string can brake it, and the strings at rest would throw it back.
FadeBand GripBrake::fade_band() const noexcept {
  const double from_m_s = by_work(kFadeFrom_m_s, kHeavyFrom_m_s);
  const double turn_J = 0.5 * body_.most_kg_m2 * ahead_.angular_rad_s.squaredNorm();
  const double left = std::sqrt(std::clamp(1 - (turn_J + stored_J_) / kReleased_J, 0.0, 1.0));
  const double share = std::max(left, kSpeedError_m_s / from_m_s);
  return {share * from_m_s, share * by_work(kFadeTo_m_s, kHeavyTo_m_s)};
}

Wrench GripBrake::apply(const Wrench& wanted, const GripMotion& motion, double dt_s) noexcept {
  const auto& [velocity_m_s, turn_rad_s] = motion.velocity();
  rest_or_return(motion.velocity(), dt_s);
  ahead_ = motion.velocity_in(kLoop_s + drive_lag_s_);
  const FadeBand band = fade_band();
  left_ = left_at(ahead_.linear_m_s.norm(), band);
  left_of_turn_ = left_at(body_.surface_m * ahead_.angular_rad_s.norm(), band);
  // Tensions for one pose exert another wrench at the next: they accelerated a grip at 300 rad/s
  // instead of braking it.
  aimed_ = std::clamp(2 - turn_rad_s.norm() * (kLoop_s + drive_lag_s_) / kAimed_rad, 0.0, 1.0);
  damper_ =
      aimed_ * Wrench{damped(ahead_.linear_m_s, 1, band, damping_N_s_m(velocity_m_s.norm())),
                      damped(ahead_.angular_rad_s, body_.surface_m, band, turn_damping(body_))};
  const double left_there = std::max(0.0, (kFar_m - away_m_.norm()) / (kFar_m - kNear_m));
  return fraction_ * Wrench{faded(wanted.force_N, away_m_, left_there), wanted.torque_Nm};
}

bool GripBrake::acts() const noexcept {
  return resting_s_ > 0 || std::min({aimed_, left_, left_of_turn_}) < 1;
}

Wrench GripBrake::limit(const Wrench& slewed) const noexcept {
  // The strings cannot exert both: a torque takes tension that the linear damper needs.
  return aimed_ *
         Wrench{without_push(slewed.force_N, ahead_.linear_m_s, left_),
                left_ * without_push(slewed.torque_Nm, ahead_.angular_rad_s, left_of_turn_)};
}

}  // namespace spidar
