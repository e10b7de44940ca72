// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/loop/grip_brake.h"

#include <algorithm>
#include <cmath>

#include "spidar/grip/grip.h"
#include "spidar/loop/brake_table.h"

namespace spidar {
namespace {

using namespace brake;

/// What is left of a force at `speed_m_s`.
double left_at(double speed_m_s, const FadeBand& band) {
  return std::clamp((band.to_m_s - speed_m_s) / (band.to_m_s - band.from_m_s), 0.0, 1.0);
}

/// Reduces the component of `vector` along `velocity` to the fraction that the speed leaves. The
/// speed of a turn is that of the end of an arm of `arm_m`; for a displacement, `arm_m` is 1.
Eigen::Vector3d faded(const Eigen::Vector3d& vector, const Eigen::Vector3d& velocity, double arm_m,
                      const FadeBand& band) {
  const double size = velocity.norm();
  const double left = left_at(arm_m * size, band);
  if (left >= 1) return vector;
  const Eigen::Vector3d direction = velocity / size;
  return vector - (1 - left) * std::max(0.0, vector.dot(direction)) * direction;
}

/// The force or torque that damps `velocity`, which is as in faded().
Eigen::Vector3d damping(const Eigen::Vector3d& velocity, double arm_m, const FadeBand& band) {
  const double speed_m_s = arm_m * velocity.norm();
  const double above_m_s = speed_m_s - band.from_m_s;
  if (!(above_m_s > 0)) return Eigen::Vector3d::Zero();
  return -arm_m * arm_m * band.damping_N_s_m * above_m_s / speed_m_s * velocity;
}

/// `vector`, whose component along `velocity` is limited to that of `most`.
Eigen::Vector3d without_excess(const Eigen::Vector3d& vector, const Eigen::Vector3d& most,
                               const Eigen::Vector3d& velocity) {
  const double excess = (vector - most).dot(velocity);
  return excess > 0 ? vector - excess / velocity.squaredNorm() * velocity : vector;
}

}  // namespace

void GripBrake::release() noexcept {
  resting_s_ = kRest_s;
}

void GripBrake::reset() noexcept {
  strings_N_.setZero();
  rest_N_.setZero();
  acting_N_.setZero();
  late_N_.setZero();
  given_m_s_.setZero();
  seen_m_s_.setZero();
  last_m_s_.setZero();
  spun_s_ = work_J_ = 0;
  located_ = balanced_ = false;
  if (!held()) release();
}

void GripBrake::pull(const Wrench& strings, const Wrench& at_rest, double dt_s) noexcept {
  // What was commanded before acts until now.
  acting_N_ += fraction_passed(dt_s, drive_lag_s_) * (strings_N_ - acting_N_);
  late_N_ += fraction_passed(dt_s, GripMotion::kLag_s) * (acting_N_ - late_N_);
  given_m_s_ += dt_s / kUnheldGrip_kg * late_N_;
  given_m_s_ *= 1 - fraction_passed(dt_s, kMemory_s);
  strings_N_ = strings.force_N;
  rest_N_ = at_rest.force_N;
}

void GripBrake::see(const Eigen::Vector3d& position_m, const GripMotion& motion, double stored_J,
                    double dt_s) noexcept {
  stored_J_ = stored_J;
  const Eigen::Vector3d& now_m_s = motion.velocity().linear_m_s;
  compare_with_force(position_m, now_m_s, dt_s);
  spun_s_ = motion.velocity().angular_rad_s.norm() > kFastest_rad_s ? spun_s_ + dt_s : 0;
  // No grip that nobody holds has more energy than the heaviest at its speed.
  const double speed_m_s = kSpeedError_m_s + std::max(now_m_s.norm(), ahead_.linear_m_s.norm());
  work_J_ = std::clamp(work_J_ + dt_s * acting_N_.dot(now_m_s), 0.0,
                       0.5 * kHeaviestGrip_kg * speed_m_s * speed_m_s);
  seen_m_s_ += now_m_s - last_m_s_;
  seen_m_s_ *= 1 - fraction_passed(dt_s, kMemory_s);
  last_m_s_ = now_m_s;
}

void GripBrake::compare_with_force(const Eigen::Vector3d& position_m,
                                   const Eigen::Vector3d& velocity_m_s, double dt_s) noexcept {
  if (resting_s_ > 0 || !located_) {
    from_m_ = position_m;
    gone_m_.setZero();
    pulled_N_.setZero();
    film_N_.setZero();
    withstood_s_ = loose_s_ = swung_J_ = 0;
    located_ = true;
  }
  const double fraction = fraction_passed(dt_s, kYieldTime_s);
  const Eigen::Vector3d moved_m = position_m - from_m_;
  gone_m_ += fraction * (moved_m - gone_m_);
  pulled_N_ += fraction * (strings_N_ - pulled_N_);
  const bool thrown = velocity_m_s.dot(moved_m) < 0 && has_stored(moved_m);
  balanced_ = is_balanced(moved_m);
  loose_s_ = has_yielded() || thrown || balanced_ ? kStored_s : loose_s_ - dt_s;
  film_N_ += fraction * (strings_N_ - rest_N_ - film_N_);
  swung_J_ =
      std::max(0.5 * film_N_.dot(gone_m_), (1 - fraction_passed(dt_s, kStored_s)) * swung_J_);
  // The film's force, because the total is zero where the strings at rest balance it.
  const double force_N = film_N_.norm();
  if (force_N < kFirmForce_N) return;
  const bool firm = kFirmHand_N_m * film_N_.dot(gone_m_) < force_N * force_N;
  withstood_s_ = firm ? withstood_s_ + dt_s : 0;
}

bool GripBrake::is_withstood() const noexcept {
  return withstood_s_ >= kWithstands_s;
}

/// A grip that is let go counts as held until it has moved far enough to show that it is not, but
/// the energy that it may have does not wait for that.
bool GripBrake::withstands_at(double speed_m_s) const noexcept {
  return is_withstood() && speed_m_s <= kHeavyFrom_m_s;
}

/// Whether a grip that has moved by `moved_m` has followed the force further than a hand lets it.
bool GripBrake::is_loose(const Eigen::Vector3d& moved_m) const noexcept {
  const double force_N = pulled_N_.norm();
  if (!(force_N > kTellingForce_N)) return false;
  const double along_m = pulled_N_.dot(moved_m) / force_N;
  return along_m >= kMinYield_m && kLooseHand_N_m * along_m >= force_N;
}

/// While the whole wrench passes, it must also have gone far, and no hand has withstood a force.
bool GripBrake::has_yielded() const noexcept {
  if (!is_loose(gone_m_)) return false;
  return fraction_ < 1 || (!is_withstood() && gone_m_.norm() > kThrown_m);
}

/// What springs store depends on where the grip is: at 0.5 m/s, the smoothed displacement lags by
/// 25 mm. To what a loose hand stores, the strings add what pulls the grip back to where they rest.
bool GripBrake::has_stored(const Eigen::Vector3d& moved_m) const noexcept {
  if (is_withstood() || !is_loose(moved_m)) return false;
  const double twice_J = kLooseHand_N_m * moved_m.squaredNorm() - rest_N_.dot(moved_m);
  return twice_J > kLooseHand_N_m * kThrown_m * kThrown_m;
}

/// An unheld grip follows a force that rises slowly to where the strings at rest balance it.
bool GripBrake::is_balanced(const Eigen::Vector3d& moved_m) const noexcept {
  return !is_withstood() && pulled_N_.norm() <= kTellingForce_N &&
         -rest_N_.dot(moved_m) > kThrows_J;
}

bool GripBrake::yields(const GripMotion& motion) const noexcept {
  if (!has_yielded()) return false;
  if (fraction_ < 1) return true;
  const Eigen::Vector3d& velocity_m_s = motion.velocity().linear_m_s;
  const double speed_m_s = velocity_m_s.norm();
  return speed_m_s > kThrown_m_s &&
         velocity_m_s.dot(pulled_N_) > kAligned * speed_m_s * pulled_N_.norm();
}

bool GripBrake::is_released(const GripMotion& motion) const noexcept {
  if (spun_s_ >= kSpins_s) return true;
  const double speed_m_s = motion.velocity().linear_m_s.norm();
  if (speed_m_s > kFastest_m_s) return true;
  const double slowest_m_s = kSlowestAtRest_m_s + fraction_ * (kSlowest_m_s - kSlowestAtRest_m_s);
  if (speed_m_s < slowest_m_s) return false;
  const double seen_m_s = seen_m_s_.norm(), given_m_s = given_m_s_.norm();
  return seen_m_s >= kMinFraction * given_m_s && seen_m_s <= kMaxFraction * given_m_s &&
         seen_m_s_.dot(given_m_s_) >= kAligned * seen_m_s * given_m_s;
}

/// A grip that nobody holds has the energy that the strings have given it, and is given what the
/// strings at rest have stored when it swings back: a film may add the rest of kReleased_J.
FadeBand GripBrake::band_at(double speed_m_s) const noexcept {
  const double heavy =
      std::clamp(std::max((work_J_ - kLightWork_J) / (kHeavyWork_J - kLightWork_J),
                          (swung_J_ - kLightSwing_J) / (kHeavySwing_J - kLightSwing_J)),
                 0.0, 1.0);
  const double earlier_m_s = loose_s_ > 0 ? kEarlier_m_s : 0;
  // A grip that is faster than the strings could have thrown the lightest one is moved by a hand,
  // or thrown by a loose hand that gives back what it has stored, but does not hold the grip.
  const double least_m_s = std::max(speed_m_s - kSpeedError_m_s, 1e-3);
  const double thrown = 2 * work_J_ / (kLightestGrip_kg * least_m_s * least_m_s);
  const double mass_kg = std::clamp(2 * work_J_ / std::max(speed_m_s * speed_m_s, 1e-6),
                                    kLightestGrip_kg, kHeaviestGrip_kg) *
                         (held() && loose_s_ <= 0 ? std::clamp(2 * thrown - 1, 0.0, 1.0) : 1.0);
  const double from_m_s = kFadeFrom_m_s + heavy * (kHeavyFrom_m_s - kFadeFrom_m_s) - earlier_m_s;
  const double to_m_s = kFadeTo_m_s + heavy * (kHeavyTo_m_s - kFadeTo_m_s) - earlier_m_s;
  double share = 1;
  if (!withstands_at(speed_m_s)) {
    const double left = std::sqrt(std::clamp(1 - stored_J_ / kReleased_J, 0.0, 1.0));
    share = std::max(left, kSpeedError_m_s / from_m_s);
  }
  return {share * from_m_s, share * to_m_s, kDamping_1_s * mass_kg};
}

Wrench GripBrake::apply(const Wrench& wanted, const GripMotion& motion, double dt_s) noexcept {
  if (is_released(motion) || (resting_s_ <= 0 && yields(motion))) release();
  if (resting_s_ > 0) {
    resting_s_ -= dt_s;
    fraction_ = std::max(0.0, fraction_ - dt_s / kRelease_s);
  } else {
    fraction_ = std::clamp(fraction_ + (balanced_ ? -dt_s / kEases_s : dt_s / kReturn_s), 0.0, 1.0);
  }
  ahead_ = motion.velocity_in(kLoop_s + drive_lag_s_);
  const double speed_m_s = motion.velocity().linear_m_s.norm();
  band_ = band_at(speed_m_s);
  damper_ = {damping(ahead_.linear_m_s, 1, band_), damping(ahead_.angular_rad_s, radius_m_, band_)};
  // The strings cannot do both: the tension that a torque takes is missing for the linear damper.
  allowed_ = {faded(fraction_ * wanted.force_N, ahead_.linear_m_s, 1, band_),
              left_at(ahead_.linear_m_s.norm(), band_) *
                  faded(fraction_ * wanted.torque_Nm, ahead_.angular_rad_s, radius_m_, band_)};
  if (!withstands_at(speed_m_s)) allowed_.force_N = not_further_out(allowed_.force_N);
  if (ahead_.linear_m_s.norm() > kNoRise_m_s) {
    allowed_.force_N = without_excess(allowed_.force_N, not_risen_N(), ahead_.linear_m_s);
  }
  return allowed_;
}

/// Reduces a force that points outwards, against the strings at rest, so that it does not bring the
/// grip to where these store more than kReleased_J.
Eigen::Vector3d GripBrake::not_further_out(const Eigen::Vector3d& force_N) const noexcept {
  const double out_N = -force_N.dot(rest_N_);
  if (!(out_N > 0)) return force_N;
  const double left = std::clamp((1 - stored_J_ / kReleased_J) / (1 - kFarOut), 0.0, 1.0);
  const double rest_N = rest_N_.norm();
  const double most_N = std::max(kProbes_N, left * out_N / rest_N);
  const double excess_N = std::max(0.0, out_N / rest_N - most_N);
  return force_N + excess_N / rest_N * rest_N_;
}

/// The limit for a force along the motion that must not rise: the film's present one, if any.
Eigen::Vector3d GripBrake::not_risen_N() const noexcept {
  const Eigen::Vector3d film_N = strings_N_ - rest_N_;
  return film_N.dot(ahead_.linear_m_s) > 0 ? film_N : Eigen::Vector3d(Eigen::Vector3d::Zero());
}

bool GripBrake::acts() const noexcept {
  const double speed_m_s =
      std::max(ahead_.linear_m_s.norm(), radius_m_ * ahead_.angular_rad_s.norm());
  return resting_s_ > 0 || ahead_.linear_m_s.norm() > kNoRise_m_s || left_at(speed_m_s, band_) < 1;
}

Wrench GripBrake::cut(const Wrench& slewed, bool fresh) const noexcept {
  if (!fresh) return left_at(ahead_.linear_m_s.norm(), band_) * slewed;
  return {without_excess(slewed.force_N, allowed_.force_N, ahead_.linear_m_s),
          without_excess(slewed.torque_Nm, allowed_.torque_Nm, ahead_.angular_rad_s)};
}

}  // namespace spidar
