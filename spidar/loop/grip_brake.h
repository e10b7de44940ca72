// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Slows down a grip that nobody holds.
#pragma once

#include <Eigen/Core>

#include "core/wrench.h"
#include "spidar/grip/grip_motion.h"

namespace spidar {

/// The speeds between which a force along the motion fades out, and the damping above the lower
/// one.
struct FadeBand {
  double from_m_s = 0, to_m_s = 0;
  double damping_N_s_m = 0;
};

/// Measures against a force that accelerates a released grip:
///
/// - A force along the velocity fades out between kFadeFrom_m_s and kFadeTo_m_s, and a torque with
///   the speed of the strings' ends. The whole torque also fades out with the speed of the grip,
///   because the damper needs the strings. Both limits are lower for a grip that is heavy or in a
///   hand, to which the strings have given more energy than a light one has at these speeds; and
///   for one in a hand that swings back after a film has pushed it aside. The speed is
///   extrapolated, with the present acceleration, to the time at which the force acts. Above
///   kNoRise_m_s, a force along the velocity does not rise.
/// - A damper acts above the lower speed. Its damping is proportional to the mass, which is twice
///   that energy divided by the square of the speed. There is none while the strings have given
///   less energy than the lightest grip has at this speed: a hand then moves the grip, and must not
///   feel the damper.
/// - The wrench goes to rest when nobody holds the grip: when it is faster than kFastest_m_s, turns
///   faster than kFastest_rad_s, or moves as the strings alone would move an unheld grip. After
///   kRest_s it returns within kReturn_s, and goes to rest again at a far lower speed if there
///   still is no hand.
/// - It also goes to rest again if the grip yields to the returning force further than a hand
///   that holds it lets it. Such a grip follows slowly, so that its speed does not give it away,
///   and stores energy in what holds it: at 3 N and 36 N/m 125 mJ, which throw 50 g at 2 m/s when a
///   film reverses its force. A grip that has followed a force to where the strings at rest balance
///   it stores energy, too; its wrench fades out until they store little. Until a hand has
///   withstood a force, a fast grip that has gone far along the force also counts as yielding. For
///   a slow grip that has gone as far, and for one that swings back from there, fading and damping
///   begin at speeds that are lower by kEarlier_m_s, because the energy stored by the hand and the
///   strings at rest adds to the work of a reversed force.
/// - Until a hand has withstood a force, and above kHeavyFrom_m_s, the energy that the strings at
///   rest have stored is subtracted from kReleased_J, and the speeds are lower accordingly.
///   Otherwise a film would push a heavy grip to where no string can brake it, and the strings at
///   rest would throw it back. For the same reason, an outward force fades to kProbes_N as that
///   energy rises from kFarOut of kReleased_J to all of it.
///
/// A fading force falls at once, without a slew limit: 10 N that fell at 300 N/s would throw a grip
/// of 50 g at 3.5 m/s. It returns at the slew limit.
///
/// The speeds, times and fractions are in brake_table.h, with their sources.
///
/// A hand that follows the force of a film notices none of these measures: with 300 N/m and 8 N s/m
/// it moves at no more than 0.45 m/s when a force of 3 N is reversed.
class GripBrake {
 public:
  /// `radius_m` is the lever at which a torque counts as a force.
  GripBrake(double radius_m, double drive_lag_s) : radius_m_(radius_m), drive_lag_s_(drive_lag_s) {}

  /// The pose is not known, or the device was opened: forgets the motion. A grip that was released
  /// stays so until kRest_s after its pose is known again.
  void reset() noexcept;
  /// Nobody holds the grip.
  void release() noexcept;

  /// Takes position and motion after an exchange, `dt_s` after the last call, and the energy that
  /// the strings at rest have stored there.
  void see(const Eigen::Vector3d& position_m, const GripMotion& motion, double stored_J,
           double dt_s) noexcept;
  /// Takes the wrench that the strings are to exert until the next exchange, and the part of it
  /// that they exert at rest.
  void pull(const Wrench& strings, const Wrench& at_rest, double dt_s) noexcept;

  /// Returns what the brake leaves of the wanted wrench.
  Wrench apply(const Wrench& wanted, const GripMotion& motion, double dt_s) noexcept;

  /// After apply(): whether cut() and damper() may change anything.
  bool acts() const noexcept;
  /// Returns what the brake leaves of `slewed`, which follows the result of the last apply() at the
  /// slew limit: along the motion, no more than that result. If not `fresh`, `slewed` is on its way
  /// to rest, and all of it fades.
  Wrench cut(const Wrench& slewed, bool fresh) const noexcept;
  /// The wrench that slows the grip down, to be added to the result of cut().
  const Wrench& damper() const noexcept { return damper_; }

  /// False while the brake withholds a part of the wrench because nobody seems to hold the grip.
  bool held() const noexcept { return fraction_ >= 1 && resting_s_ <= 0; }

 private:
  FadeBand band_at(double speed_m_s) const noexcept;
  Eigen::Vector3d not_further_out(const Eigen::Vector3d& force_N) const noexcept;
  Eigen::Vector3d not_risen_N() const noexcept;
  bool is_released(const GripMotion& motion) const noexcept;
  bool is_withstood() const noexcept;
  bool withstands_at(double speed_m_s) const noexcept;
  bool is_loose(const Eigen::Vector3d& moved_m) const noexcept;
  bool has_yielded() const noexcept;
  bool has_stored(const Eigen::Vector3d& moved_m) const noexcept;
  bool is_balanced(const Eigen::Vector3d& moved_m) const noexcept;
  bool yields(const GripMotion& motion) const noexcept;
  void compare_with_force(const Eigen::Vector3d& position_m, const Eigen::Vector3d& velocity_m_s,
                          double dt_s) noexcept;

  const double radius_m_;
  const double drive_lag_s_;
  // What the strings gave an unheld grip in the last kMemory_s, and what was seen.
  Eigen::Vector3d strings_N_ = Eigen::Vector3d::Zero();  ///< commanded
  Eigen::Vector3d rest_N_ = Eigen::Vector3d::Zero();  ///< the part of it that strings at rest exert
  Eigen::Vector3d acting_N_ = Eigen::Vector3d::Zero();  ///< after the drive's lag
  Eigen::Vector3d late_N_ = Eigen::Vector3d::Zero();    ///< as late as the velocity is
  Eigen::Vector3d given_m_s_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d seen_m_s_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d last_m_s_ = Eigen::Vector3d::Zero();
  double spun_s_ = 0;  ///< for how long it has turned faster than a hand
  // Force and displacement, smoothed, since the force rested or the film began.
  bool located_ = false;  ///< whether from_m_ is known
  Eigen::Vector3d from_m_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d gone_m_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d pulled_N_ = Eigen::Vector3d::Zero();  ///< by all tensions, …
  Eigen::Vector3d film_N_ = Eigen::Vector3d::Zero();    ///< … by those above the rest's
  double stored_J_ = 0;                                 ///< what the strings at rest give back
  double swung_J_ = 0;  ///< what a hand that gave way to the film gives back, fading
  double work_J_ = 0;   ///< what the strings have given the grip since it was last at rest
  // Of the last apply().
  GripVelocity ahead_;  ///< extrapolated to the time at which the force acts
  FadeBand band_;
  Wrench allowed_;
  Wrench damper_;
  bool balanced_ = false;   ///< whether the strings at rest balance the force on the grip
  double withstood_s_ = 0;  ///< how long a hand has withstood a force, without a break
  double loose_s_ = 0;      ///< for how long the grip still counts as one that has stored energy
  double fraction_ = 1;     ///< of the wanted wrench that is passed on
  double resting_s_ = 0;    ///< time until the wrench begins to return
};

}  // namespace spidar
