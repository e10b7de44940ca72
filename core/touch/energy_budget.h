// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <limits>
#include <optional>

#include <Eigen/Core>

#include "core/history.h"
#include "core/wrench.h"

namespace spidar::touch {

/// The path from a wanted force to the motion of the grip.
struct ForcePath {
  double max_force_N = std::numeric_limits<double>::infinity();  ///< of the safety chain
  double max_slew_N_s = 300;                                     ///< of the safety chain
  double lag_s = 0.002;             ///< first-order lag of the drive; ≥ 0
  double velocity_lag_s = 0.00615;  ///< from a velocity of the grip to the force that follows it
  double least_mass_kg = 0.05;      ///< of the grip and what moves with it
  /// How long the drives hold a force, unless the next tick is late.
  double tick_s = 0.001;
  double longest_tick_s = 0.002;  ///< the longest tick that counts in the safety chain's slew limit
};

/// Limits the energy that a contact returns to the hand: counts the energy that the contact has
/// absorbed, and bounds the force so that the contact returns no more. This is a passivity observer
/// and controller (B. Hannaford and J.-H. Ryu, Time-domain passivity control of haptic interfaces,
/// IEEE Transactions on Robotics and Automation 18, 2002) with a prediction. An observer of the
/// past is not enough: a force with limited slew and a lag still pushes after the energy is spent.
///
/// A force F that falls at the slew limit from the next tick on still delivers the impulse J = lag
/// · (force on the grip) + F · tick + F² / (2 · slew). On a mass m that moves outwards at v, this
/// impulse does the work v J + J² / (2 m). The bound is the F for which this work equals the energy
/// that is left.
///
/// `dt_s` is the time since the last tick; it is long for a late tick, and short for the next one.
class EnergyBudget {
 public:
  /// Call once per tick, before choosing the force. `moved_m` is the displacement of the grip since
  /// the last tick, from the poses of the last two exchanges. `added_J` is the energy added by the
  /// motion of the surface. `stored_J` is the energy stored in the spring, 0 without contact; the
  /// energy left never exceeds it.
  void update(const Eigen::Vector3d& moved_m, const Eigen::Vector3d& velocity_m_s, double added_J,
              double stored_J) noexcept;

  /// The fraction of `wanted_N` that is allowed. A force that was bounded rises again no faster
  /// than the slew limit of the path.
  double allowed_fraction(const Eigen::Vector3d& wanted_N, const ForcePath& path,
                          double dt_s) noexcept;

  /// The largest allowed force along the unit vector `direction`.
  double allowed_force_N(const Eigen::Vector3d& direction, const ForcePath& path,
                         double dt_s) const noexcept;

  /// Sets the force of this tick, before the limits of the path. `beside_N` is a force that does
  /// not come from the contact, and shares the limits. The contact's part is the limited sum of
  /// both, minus the limited `beside_N` alone.
  void command(const Eigen::Vector3d& wanted_N, const Eigen::Vector3d& beside_N,
               const ForcePath& path, double dt_s) noexcept;

  /// Replaces the force of this tick by the wrench that the device delivers, which may be smaller,
  /// point elsewhere and have a torque. The delivered force is taken to be the commanded one
  /// without this call, and also beside another force, because the contact's part is then unknown.
  /// `turn_rad` is the rotation of the grip since the last exchange.
  void set_delivered(const Wrench& given, const Eigen::Vector3d& turn_rad) noexcept;

  /// Estimate of the energy that this contact has absorbed from the hand and not yet returned.
  double left_J() const noexcept { return left_J_; }
  const Eigen::Vector3d& force_N() const noexcept { return acting_.force_N; }

 private:
  void apply_lag(const Wrench& own) noexcept;

  // The number of ticks, each on time, over which the acceleration is measured.
  static constexpr int kSlope = 3;

  double left_J_ = 0;
  double bounded_N_ = std::numeric_limits<double>::infinity();  ///< infinite: not bounded
  // The direction of a smaller force is uncertain: the steps of a D/A converter are 5 mN.
  static constexpr double kKnownDirection_N = 0.05;
  // After a late tick come short ones, so more of them fit into the time of kSlope.
  static constexpr size_t kKept = 16;
  History<Eigen::Vector3d, kKept + 1> velocity_m_s_;
  History<double, kKept> dt_s_;                          ///< durations of the last ticks
  Eigen::Vector3d limited_N_ = Eigen::Vector3d::Zero();  ///< contact and beside_N, limited
  Eigen::Vector3d beside_N_ = Eigen::Vector3d::Zero();   ///< alone, with the same limits
  double fading_ = 0;     ///< fraction of the earlier force left after a tick
  double lag_ticks_ = 0;  ///< lag / tick
  Wrench begun_;          ///< on the grip, at the beginning of the last tick
  Wrench acting_;         ///< on the grip, at the end of the last tick
  Wrench mean_;           ///< on the grip, mean over the last tick
  Eigen::Vector3d before_N_ = Eigen::Vector3d::Zero();   ///< mean force of the tick before
  Eigen::Vector3d turned_Nm_ = Eigen::Vector3d::Zero();  ///< mean_.torque_Nm of the tick before
  std::optional<Eigen::Vector3d> given_;                 ///< delivered force per newton commanded
};

}  // namespace spidar::touch
