// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <Eigen/Core>

#include "core/wrench.h"
#include "spidar/chain/brake_table.h"
#include "spidar/grip/grip_motion.h"
#include "spidar/profiles/grip_body.h"

namespace spidar {

/// The speeds between which a force fades out.
struct FadeBand {
  double from_m_s = 0, to_m_s = 0;
};

/// Reduces a wrench that would accelerate a released grip, by four measures:
///
/// - Speed: a force that does not brake the motion fades out between the speeds of a FadeBand, and
///   a torque with the speed of the grip's surface. The whole torque also fades out with the speed
///   of the grip, because the damper needs the strings. A damper acts above the lower speed. The
///   speed is extrapolated, with the present acceleration, to the time at which the force acts.
/// - Energy: the speeds of the band are lower after the strings have given the grip more energy
///   than a light one has at these speeds. The energy of its rotation and of the strings at rest
///   lowers them further.
/// - Place: a force fades out while it pushes the grip away from where it has been for some
///   seconds. The brake does not see the spring of a loose hand, so that spring must not store
///   much.
/// - Rest: the wrench goes to rest when the grip or its surface has been fast for kFast_s; half of
///   the time in which it was slow is subtracted. After kRest_s it returns within kReturn_s.
///
/// What speed and energy leave of a force changes at once, without a slew limit: at 300 N/s, 10 N
/// would throw a grip of 50 g at 3.5 m/s; and while 9 N across the motion fell, the motion turned
/// towards them, up to 1.8 m/s. By place and at rest, a force changes at the slew limit. The
/// constants are in brake_table.h, with their sources.
///
/// A still hand that follows a film of 3 N notices none of these measures: with 300 N/m and 8 N s/m
/// it moves at no more than 0.45 m/s when the force is reversed.
class GripBrake {
 public:
  GripBrake(const GripBody& body, double drive_lag_s) : body_(body), drive_lag_s_(drive_lag_s) {}

  /// Clears the motion, because the pose is unknown. A released grip stays released until kRest_s
  /// after its pose is known again.
  void reset() noexcept;
  /// Forgets where the grip has been, because the device was opened.
  void forget_place() noexcept { knows_place_ = false; }
  /// Puts the wrench to rest for kRest_s, because nobody holds the grip.
  void release() noexcept { resting_s_ = brake::kRest_s; }

  // Call these in each tick, in this order:

  /// Returns the wanted wrench, reduced by place and rest.
  Wrench apply(const Wrench& wanted, const GripMotion& motion, double dt_s) noexcept;
  /// Whether limit() and damper() may change the wrench.
  bool acts() const noexcept;
  /// Reduces `slewed`, which follows the result of apply() at the slew limit, by speed and energy.
  Wrench limit(const Wrench& slewed) const noexcept;
  /// The wrench that slows the grip down, to add to the result of limit().
  const Wrench& damper() const noexcept { return damper_; }
  /// Updates the brake with the position and motion after an exchange, `dt_s` after the last call,
  /// and with the energy that the strings at rest have stored at that position.
  void update(const Eigen::Vector3d& position_m, const GripMotion& motion, double stored_J,
              double dt_s) noexcept;
  /// Updates the brake with the force that the strings exert until the next exchange, and with the
  /// part of it that they would exert at rest.
  void pull(const Eigen::Vector3d& strings_N, const Eigen::Vector3d& at_rest_N,
            double dt_s) noexcept;

  /// False while the brake withholds a part of the wrench because nobody seems to hold the grip.
  bool held() const noexcept { return fraction_ >= 1 && resting_s_ <= 0; }

 private:
  void rest_or_return(const GripVelocity& velocity, double dt_s) noexcept;
  double by_work(double light, double heavy) const noexcept;
  double damping_N_s_m(double speed_m_s) const noexcept;
  FadeBand fade_band() const noexcept;

  const GripBody body_;
  const double drive_lag_s_;
  Eigen::Vector3d strings_N_ = Eigen::Vector3d::Zero();  ///< commanded
  Eigen::Vector3d film_N_ = Eigen::Vector3d::Zero();     ///< of it, what is not exerted at rest
  Eigen::Vector3d acting_N_ = Eigen::Vector3d::Zero();   ///< after the drive's lag
  double work_J_ = 0;    ///< what the strings have given the grip since it was last at rest
  double stored_J_ = 0;  ///< energy that the strings at rest can return
  bool knows_place_ = false;
  Eigen::Vector3d place_m_ = Eigen::Vector3d::Zero();  ///< where the grip has been for some seconds
  Eigen::Vector3d away_m_ = Eigen::Vector3d::Zero();   ///< from there to the grip
  double fast_s_ = 0;     ///< time for which the grip was fast, minus half of the slow time
  double fraction_ = 1;   ///< the fraction of the wanted wrench that passes
  double resting_s_ = 0;  ///< time until the wrench begins to return
  // Results of the last apply().
  GripVelocity ahead_;                  ///< extrapolated to the time at which the force acts
  double left_ = 1, left_of_turn_ = 1;  ///< fractions of force and torque that the speeds leave
  double aimed_ = 1;  ///< fraction of a wrench to exert, because the grip rotates meanwhile
  Wrench damper_;
};

}  // namespace spidar
