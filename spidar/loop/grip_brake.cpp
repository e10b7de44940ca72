// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/loop/grip_brake.h"

#include <algorithm>
#include <cmath>

#include "spidar/grip/grip.h"
#include "spidar/limits/released_turn.h"
#include "spidar/loop/brake_table.h"
#include "spidar/loop/turn_damping.h"

namespace spidar {
namespace {

using namespace brake;

/// The rotation up to which a wrench keeps its full size: the cosine of the error is 0.88.
constexpr double kAimed_rad = 0.5;

/// The fraction of a force that remains at `speed_m_s` in the band.
double left_at(double speed_m_s, const FadeBand& band) {
  return std::clamp((band.to_m_s - speed_m_s) / (band.to_m_s - band.from_m_s), 0.0, 1.0);
}

/// Reduces the component of `vector` along `velocity` to the fraction that the band leaves. The
/// speed of a rotation is that of the end of an arm of `arm_m`; for a displacement, `arm_m` is 1.
Eigen::Vector3d faded(const Eigen::Vector3d& vector, const Eigen::Vector3d& velocity, double arm_m,
                      const FadeBand& band) {
  const double size = velocity.norm();
  const double left = left_at(arm_m * size, band);
  if (left >= 1) return vector;
  const Eigen::Vector3d direction = velocity / size;
  return vector - (1 - left) * std::max(0.0, vector.dot(direction)) * direction;
}

/// The force or torque that damps the part of `velocity` above the lower speed of the band. The
/// speed is as in faded(), and `damping` is in N s/m or N m s/rad.
Eigen::Vector3d damped(const Eigen::Vector3d& velocity, double arm_m, const FadeBand& band,
                       double damping) {
  const double speed_m_s = arm_m * velocity.norm();
  const double above_m_s = speed_m_s - band.from_m_s;
  if (!(above_m_s > 0)) return Eigen::Vector3d::Zero();
  return -damping * above_m_s / speed_m_s * velocity;
}

/// The fraction of a wrench to exert if the grip rotates by `turn_rad` before the wrench acts.
/// Tensions for one pose exert another wrench at the next: they accelerated a grip at 300 rad/s
/// instead of braking it.
double aimed_at(double turn_rad) {
  return std::clamp(2 - turn_rad / kAimed_rad, 0.0, 1.0);
}

/// Limits the component of `vector` along `velocity` to the component of `most`.
Eigen::Vector3d without_excess(const Eigen::Vector3d& vector, const Eigen::Vector3d& most,
                               const Eigen::Vector3d& velocity) {
  const double excess = (vector - most).dot(velocity);
  return excess > 0 ? vector - excess / velocity.squaredNorm() * velocity : vector;
}

}  // namespace

void GripBrake::reset() noexcept {
  strings_N_.setZero();
  rest_N_.setZero();
  acting_N_.setZero();
  work_J_ = spun_s_ = 0;
  unheld_.reset();
  yield_.begin();
  if (!held()) release();
}

void GripBrake::pull(const Wrench& strings, const Wrench& at_rest, double dt_s) noexcept {
  // The previous command has acted until now.
  acting_N_ += fraction_passed(dt_s, drive_lag_s_) * (strings_N_ - acting_N_);
  unheld_.pull(acting_N_, dt_s);
  strings_N_ = strings.force_N;
  rest_N_ = at_rest.force_N;
}

void GripBrake::update(const Eigen::Vector3d& position_m, const GripMotion& motion, double stored_J,
                       double dt_s) noexcept {
  const auto& [velocity_m_s, turn_rad_s] = motion.velocity();
  stored_J_ = stored_J;
  if (resting_s_ > 0) yield_.begin();
  yield_.update(position_m, velocity_m_s, strings_N_, rest_N_, is_whole(), dt_s);
  unheld_.update(velocity_m_s, dt_s);
  // A grip that rotates to and fro is slow twice in each period.
  const bool is_fast = turn_rad_s.norm() > kFastest_rad_s;
  spun_s_ = std::clamp(spun_s_ + (is_fast ? dt_s : -dt_s / 2), 0.0, kSpins_s);
  // No unheld grip has more energy than the heaviest at its speed.
  const double speed_m_s =
      kSpeedError_m_s + std::max(velocity_m_s.norm(), ahead_.linear_m_s.norm());
  work_J_ = std::clamp(work_J_ + dt_s * acting_N_.dot(velocity_m_s), 0.0,
                       0.5 * kHeaviestGrip_kg * speed_m_s * speed_m_s);
}

bool GripBrake::is_released(const GripMotion& motion) const noexcept {
  if (spun_s_ >= kSpins_s) return true;
  const Eigen::Vector3d& velocity_m_s = motion.velocity().linear_m_s;
  const double speed_m_s = velocity_m_s.norm();
  if (speed_m_s > kFastest_m_s) return true;
  const double slowest_m_s = kSlowestAtRest_m_s + fraction_ * (kSlowest_m_s - kSlowestAtRest_m_s);
  if (speed_m_s >= slowest_m_s && unheld_.is_recognised()) return true;
  return resting_s_ <= 0 && yield_.yields(velocity_m_s, is_whole());
}

void GripBrake::rest_or_return(const GripMotion& motion, double dt_s) noexcept {
  if (is_released(motion)) release();
  double step = yield_.is_balanced() ? -dt_s / kEases_s : dt_s / kReturn_s;
  if (resting_s_ > 0) {
    resting_s_ -= dt_s;
    step = -dt_s / kRelease_s;
  }
  fraction_ = std::clamp(fraction_ + step, 0.0, 1.0);
}

/// Whether a hand withstands the force. A released grip counts as held until its motion shows the
/// release; its possible energy must count before that, so a fast grip counts as not withstanding.
bool GripBrake::withstands_at(double speed_m_s) const noexcept {
  return yield_.is_withstood() && speed_m_s <= kHeavyFrom_m_s;
}

/// The weight of the lower FadeBand, that of a heavy grip, 0 … 1. It rises with the energy that
/// the strings have given to the grip, which exceeds that of a light grip at these speeds if the
/// grip is heavy or in a hand, and with the energy of a hand that swings back after a film's push.
double GripBrake::heaviness() const noexcept {
  const double of_work = (work_J_ - kLightWork_J) / (kHeavyWork_J - kLightWork_J);
  const double of_swing = (yield_.swung_J() - kLightSwing_J) / (kHeavySwing_J - kLightSwing_J);
  return std::clamp(std::max(of_work, of_swing), 0.0, 1.0);
}

/// The mass that is damped: twice the energy that the strings have given, divided by the square of
/// the speed. If the strings have given less than the lightest grip has at this speed, a hand moves
/// the grip and must not feel the damper, so the mass is zero; except for a grip that is not held,
/// or has stored energy, which a loose hand returns without holding the grip.
double GripBrake::damped_kg(double speed_m_s) const noexcept {
  const double mass_kg = std::clamp(2 * work_J_ / std::max(speed_m_s * speed_m_s, 1e-6),
                                    kLightestGrip_kg, kHeaviestGrip_kg);
  if (!held() || yield_.stores_energy()) return mass_kg;
  const double least_m_s = std::max(speed_m_s - kSpeedError_m_s, 1e-3);
  const double thrown = 2 * work_J_ / (kLightestGrip_kg * least_m_s * least_m_s);
  return mass_kg * std::clamp(2 * thrown - 1, 0.0, 1.0);
}

/// For a grip that has stored energy, the speeds are lower by kEarlier_m_s, because that energy
/// adds to the work of a reversed force. The largest energy of the rotation is subtracted from
/// kReleased_J, and the speeds are lower accordingly. The energy that the strings at rest have
/// stored is also subtracted until a hand has withstood a force, and always above kHeavyFrom_m_s.
/// Otherwise a film would push a heavy grip to where no string can brake it, and the strings at
/// rest would throw it back.
FadeBand GripBrake::band_at(double speed_m_s) const noexcept {
  const double heavy = heaviness(), earlier_m_s = yield_.stores_energy() ? kEarlier_m_s : 0;
  const double from_m_s = kFadeFrom_m_s + heavy * (kHeavyFrom_m_s - kFadeFrom_m_s) - earlier_m_s;
  const double to_m_s = kFadeTo_m_s + heavy * (kHeavyTo_m_s - kFadeTo_m_s) - earlier_m_s;
  const double turn_J = 0.5 * body_.most_kg_m2 * ahead_.angular_rad_s.squaredNorm();
  const double other_J = turn_J + (withstands_at(speed_m_s) ? 0 : stored_J_);
  const double left = std::sqrt(std::clamp(1 - other_J / kReleased_J, 0.0, 1.0));
  const double share = std::max(left, std::min(1.0, kSpeedError_m_s / from_m_s));
  return {share * from_m_s, share * to_m_s, kDamping_1_s * damped_kg(speed_m_s)};
}

Wrench GripBrake::apply(const Wrench& wanted, const GripMotion& motion, double dt_s) noexcept {
  rest_or_return(motion, dt_s);
  ahead_ = motion.velocity_in(kLoop_s + drive_lag_s_);
  const double speed_m_s = motion.velocity().linear_m_s.norm();
  band_ = band_at(speed_m_s);
  const double arm_m = body_.surface_m;
  damper_ = {damped(ahead_.linear_m_s, 1, band_, band_.damping_N_s_m),
             damped(ahead_.angular_rad_s, arm_m, band_, turn_damping(body_))};
  // The strings cannot exert both: a torque takes tension that the linear damper needs.
  allowed_ = {faded(fraction_ * wanted.force_N, ahead_.linear_m_s, 1, band_),
              left_at(ahead_.linear_m_s.norm(), band_) *
                  faded(fraction_ * wanted.torque_Nm, ahead_.angular_rad_s, arm_m, band_)};
  const double aimed = aimed_at(motion.velocity().angular_rad_s.norm() * (kLoop_s + drive_lag_s_));
  allowed_ = aimed * allowed_;
  damper_ = aimed * damper_;
  if (!withstands_at(speed_m_s)) allowed_.force_N = not_further_out(allowed_.force_N);
  if (ahead_.linear_m_s.norm() > kNoRise_m_s) {
    allowed_.force_N = without_excess(allowed_.force_N, not_risen_N(), ahead_.linear_m_s);
  }
  return allowed_;
}

/// Reduces a force against the strings at rest, which points outwards, to kProbes_N as the energy
/// that these strings have stored rises from kFarOut · kReleased_J to kReleased_J.
Eigen::Vector3d GripBrake::not_further_out(const Eigen::Vector3d& force_N) const noexcept {
  const double out_N = -force_N.dot(rest_N_);
  if (!(out_N > 0)) return force_N;
  const double left = std::clamp((1 - stored_J_ / kReleased_J) / (1 - kFarOut), 0.0, 1.0);
  const double rest_N = rest_N_.norm();
  const double most_N = std::max(kProbes_N, left * out_N / rest_N);
  const double excess_N = std::max(0.0, out_N / rest_N - most_N);
  return force_N + excess_N / rest_N * rest_N_;
}

/// The limit for a force along the motion that must not rise: the film's present force along it.
Eigen::Vector3d GripBrake::not_risen_N() const noexcept {
  const Eigen::Vector3d film_N = strings_N_ - rest_N_;
  return film_N.dot(ahead_.linear_m_s) > 0 ? film_N : Eigen::Vector3d(Eigen::Vector3d::Zero());
}

bool GripBrake::acts() const noexcept {
  const double speed_m_s =
      std::max(ahead_.linear_m_s.norm(), body_.surface_m * ahead_.angular_rad_s.norm());
  return resting_s_ > 0 || ahead_.linear_m_s.norm() > kNoRise_m_s || left_at(speed_m_s, band_) < 1;
}

Wrench GripBrake::cut(const Wrench& slewed, bool fresh) const noexcept {
  if (!fresh) return left_at(ahead_.linear_m_s.norm(), band_) * slewed;
  return {without_excess(slewed.force_N, allowed_.force_N, ahead_.linear_m_s),
          without_excess(slewed.torque_Nm, allowed_.torque_Nm, ahead_.angular_rad_s)};
}

}  // namespace spidar
