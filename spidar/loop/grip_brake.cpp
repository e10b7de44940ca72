// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/loop/grip_brake.h"

#include <algorithm>
#include <cmath>

namespace spidar {
namespace {

/// A bare grip is compared over this time with what the strings did to it. A hand of 100 N/m takes
/// 30 ms to stop a grip.
constexpr double kMemory_s = 0.05;
/// A slower grip is not examined while the whole wrench acts, and while none of it does. A hand of
/// 300 N/m is never moved as fast as the former.
constexpr double kSlowest_m_s = 0.55;
constexpr double kSlowestAtRest_m_s = 0.15;
/// From the full wrench to rest; the slew limit of the safety chain comes after it.
constexpr double kRelease_s = 0.01;
/// The grip must move within 37° of the way that the strings would move it, …
constexpr double kAligned = 0.8;
/// … and at no less than this share and no more than this multiple of the speed.
constexpr double kLeastShare = 0.9;
constexpr double kMostShare = 3;
/// From a pose to the force that depends on it: a tick until the next exchange, and half a tick in
/// which it is held.
constexpr double kLoop_s = 1.5e-3;

/// Of `vector`, the part along `velocity` is reduced to the share that `speed` leaves.
Eigen::Vector3d faded(const Eigen::Vector3d& vector, const Eigen::Vector3d& velocity,
                      double metres) {
  const double size = velocity.norm();
  const double speed_m_s = metres * size;
  if (speed_m_s <= GripBrake::kFadeFrom_m_s) return vector;
  const Eigen::Vector3d direction = velocity / size;
  const double along = std::max(0.0, vector.dot(direction));
  const double left =
      (GripBrake::kFadeTo_m_s - speed_m_s) / (GripBrake::kFadeTo_m_s - GripBrake::kFadeFrom_m_s);
  return vector - (1 - std::max(0.0, left)) * along * direction;
}

/// The damping force, at the end of an arm of `metres` for a turn.
Eigen::Vector3d damping(const Eigen::Vector3d& velocity, double metres) {
  const double speed_m_s = metres * velocity.norm();
  const double above_m_s = speed_m_s - GripBrake::kDampedFrom_m_s;
  if (!(above_m_s > 0)) return Eigen::Vector3d::Zero();
  return -metres * metres * GripBrake::kDamping_N_s_m * above_m_s / speed_m_s * velocity;
}

}  // namespace

void GripBrake::reset() noexcept {
  strings_N_.setZero();
  acting_N_.setZero();
  late_N_.setZero();
  given_m_s_.setZero();
  seen_m_s_.setZero();
  last_m_s_.setZero();
}

void GripBrake::pull(const Wrench& strings, double dt_s) noexcept {
  // What was told before acts until now.
  acting_N_ += share_passed(dt_s, drive_lag_s_) * (strings_N_ - acting_N_);
  late_N_ += share_passed(dt_s, GripMotion::kLag_s) * (acting_N_ - late_N_);
  given_m_s_ += dt_s / kBareGrip_kg * late_N_;
  given_m_s_ *= 1 - share_passed(dt_s, kMemory_s);
  strings_N_ = strings.force_N;
}

void GripBrake::see(const GripMotion& motion, double dt_s) noexcept {
  const Eigen::Vector3d& now_m_s = motion.velocity().linear_m_s;
  seen_m_s_ += now_m_s - last_m_s_;
  seen_m_s_ *= 1 - share_passed(dt_s, kMemory_s);
  last_m_s_ = now_m_s;
}

bool GripBrake::is_released(const GripMotion& motion) const noexcept {
  const double speed_m_s = motion.velocity().linear_m_s.norm();
  if (speed_m_s > kFastest_m_s) return true;
  const double slowest_m_s = kSlowestAtRest_m_s + share_ * (kSlowest_m_s - kSlowestAtRest_m_s);
  if (speed_m_s < slowest_m_s) return false;
  const double seen_m_s = seen_m_s_.norm(), given_m_s = given_m_s_.norm();
  return seen_m_s >= kLeastShare * given_m_s && seen_m_s <= kMostShare * given_m_s &&
         seen_m_s_.dot(given_m_s_) >= kAligned * seen_m_s * given_m_s;
}

Wrench GripBrake::apply(const Wrench& wanted, const GripMotion& motion, double dt_s) noexcept {
  if (is_released(motion)) resting_s_ = kRest_s;
  if (resting_s_ > 0) {
    resting_s_ -= dt_s;
    share_ = std::max(0.0, share_ - dt_s / kRelease_s);
  } else {
    share_ = std::min(1.0, share_ + dt_s / kReturn_s);
  }
  const GripVelocity then = motion.velocity_in(kLoop_s + drive_lag_s_);
  const Wrench left{faded(share_ * wanted.force_N, then.linear_m_s, 1),
                    faded(share_ * wanted.torque_Nm, then.angular_rad_s, radius_m_)};
  return left + Wrench{damping(then.linear_m_s, 1), damping(then.angular_rad_s, radius_m_)};
}

}  // namespace spidar
