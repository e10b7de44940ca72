// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <Eigen/Core>

#include "core/wrench.h"
#include "spidar/grip/grip_motion.h"
#include "spidar/loop/grip_yield.h"
#include "spidar/loop/unheld_motion.h"
#include "spidar/profiles/grip_body.h"

namespace spidar {

/// The speeds between which a force along the motion fades out, and the damping above `from_m_s`.
struct FadeBand {
  double from_m_s = 0, to_m_s = 0;
  double damping_N_s_m = 0;
};

/// Reduces a wrench that would accelerate a released grip:
///
/// - A force along the velocity fades out between the speeds of a FadeBand, and a torque with the
///   speed of the strings' ends. The whole torque also fades out with the speed of the grip,
///   because the damper needs the strings. The speed is extrapolated, with the present
///   acceleration, to the time at which the force acts. Above kNoRise_m_s, a force along the
///   velocity does not rise.
/// - A damper acts above the lower speed.
/// - The wrench goes to rest when nobody holds the grip: when it is faster than kFastest_m_s, turns
///   faster than kFastest_rad_s, moves as the strings alone would move it (UnheldMotion), or yields
///   to the force (GripYield). After kRest_s it returns within kReturn_s, and goes to rest again at
///   a far lower speed if there still is no hand.
/// - Until a hand has withstood a force, the wrench fades out while the strings at rest balance it,
///   and an outward force fades with the energy that these have stored.
///
/// A fading force falls at once, without a slew limit: 10 N that fell at 300 N/s would throw a grip
/// of 50 g at 3.5 m/s. It returns at the slew limit. The speeds, times and fractions are in
/// brake_table.h, with their sources.
///
/// A hand that follows the force of a film notices none of these measures: with 300 N/m and 8 N s/m
/// it moves at no more than 0.45 m/s when a force of 3 N is reversed.
class GripBrake {
 public:
  GripBrake(const GripBody& body, double drive_lag_s) : body_(body), drive_lag_s_(drive_lag_s) {}

  /// Clears the motion, because the pose is unknown or the device was opened. A released grip stays
  /// released until kRest_s after its pose is known again.
  void reset() noexcept;
  /// Puts the wrench to rest for kRest_s, because nobody holds the grip.
  void release() noexcept { resting_s_ = brake::kRest_s; }

  // Call these in each tick, in this order:

  /// Returns the wanted wrench, reduced by the brake.
  Wrench apply(const Wrench& wanted, const GripMotion& motion, double dt_s) noexcept;
  bool acts() const noexcept;
  /// Reduces `slewed`, which follows the result of the last apply() at the slew limit, to no more
  /// than that result along the motion. If not `fresh`, `slewed` is ramping to zero, and all of it
  /// fades.
  Wrench cut(const Wrench& slewed, bool fresh) const noexcept;
  /// The wrench that slows the grip down, to add to the result of cut().
  const Wrench& damper() const noexcept { return damper_; }
  /// Updates the brake with the position and motion after an exchange, `dt_s` after the last call,
  /// and with the energy that the strings at rest have stored at that position.
  void update(const Eigen::Vector3d& position_m, const GripMotion& motion, double stored_J,
              double dt_s) noexcept;
  /// Updates the brake with the wrench that the strings exert until the next exchange, and with the
  /// part of it that they exert at rest.
  void pull(const Wrench& strings, const Wrench& at_rest, double dt_s) noexcept;

  /// False while the brake withholds a part of the wrench because nobody seems to hold the grip.
  bool held() const noexcept { return is_whole() && resting_s_ <= 0; }

 private:
  bool is_whole() const noexcept { return fraction_ >= 1; }
  bool is_released(const GripMotion& motion) const noexcept;
  void rest_or_return(const GripMotion& motion, double dt_s) noexcept;
  bool withstands_at(double speed_m_s) const noexcept;
  double heaviness() const noexcept;
  double damped_kg(double speed_m_s) const noexcept;
  FadeBand band_at(double speed_m_s) const noexcept;
  Eigen::Vector3d not_further_out(const Eigen::Vector3d& force_N) const noexcept;
  Eigen::Vector3d not_risen_N() const noexcept;

  const GripBody body_;
  const double drive_lag_s_;
  // The strings.
  Eigen::Vector3d strings_N_ = Eigen::Vector3d::Zero();  ///< commanded
  Eigen::Vector3d rest_N_ = Eigen::Vector3d::Zero();  ///< the part of it that strings at rest exert
  Eigen::Vector3d acting_N_ = Eigen::Vector3d::Zero();  ///< after the drive's lag
  double stored_J_ = 0;  ///< energy that the strings at rest can return
  double work_J_ = 0;    ///< work of the strings on the grip since it was last at rest
  // The grip.
  brake::UnheldMotion unheld_;
  brake::GripYield yield_;
  double spun_s_ = 0;  ///< how long the grip has rotated faster than a hand can
  // Results of the last apply().
  GripVelocity ahead_;  ///< extrapolated to the time at which the force acts
  FadeBand band_;
  Wrench allowed_;
  Wrench damper_;
  double fraction_ = 1;   ///< the fraction of the wanted wrench that passes
  double resting_s_ = 0;  ///< time until the wrench begins to return
};

}  // namespace spidar
