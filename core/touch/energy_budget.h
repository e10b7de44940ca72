// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What a contact may give back to the hand.
#pragma once

#include <array>
#include <limits>

#include <Eigen/Core>

#include "core/api.h"

namespace spidar {

/// What is known of the way from a wanted force to how it moves the grip.
struct ForcePath {
  double max_force_N = std::numeric_limits<double>::infinity();  ///< that is let through
  double max_slew_N_s = 300;                                     ///< that is let through
  double lag_s = 0.002;             ///< of the drive, first order; ≥ 0
  double velocity_lag_s = 0.00615;  ///< from a velocity that is told to when a force acts
  double least_mass_kg = 0.05;      ///< of the grip with what moves along with it
};

/// Follows the energy that a contact has taken from the hand, and bounds the force so that the
/// contact does not give more than that back: a passivity observer and controller (B. Hannaford and
/// J.-H. Ryu, Time-domain passivity control of haptic interfaces, IEEE Transactions on Robotics and
/// Automation 18, 2002) that looks ahead. Looking back is not enough: a force that may change only
/// so fast, and that lags behind, still pushes when the energy is spent.
///
/// A force F that is taken back from now on as fast as it may be still has the impulse
/// J = lag · (force on the grip) + F · tick + F² / (2 · slew). On a mass m that moves outwards at v
/// it does the work v J + J² / (2 m). The bound is the F for which this is what is left.
class SPIDAR_API EnergyBudget {
 public:
  /// Once a tick, before its force is chosen. `way_m`: how the grip has moved since the last tick,
  /// by its places before the last exchange and the one before that. `put_in_J`: by the surface's
  /// own move. `stored_J`: what the spring holds, 0 where nothing is touched; no more than that is
  /// ever left.
  void follow(const Eigen::Vector3d& way_m, const Eigen::Vector3d& velocity_m_s, double put_in_J,
              double stored_J) noexcept;

  /// The largest force in a direction of length 1.
  double most_N(const Eigen::Vector3d& direction, const ForcePath& path,
                double dt_s) const noexcept;

  /// The force of this tick, before the limits of the path. It shares them with `beside_N`, a force
  /// that does not come from the contact: the contact's part of what is let through is what is
  /// more than it would be without the contact.
  void command(const Eigen::Vector3d& wanted_N, const Eigen::Vector3d& beside_N,
               const ForcePath& path, double dt_s) noexcept;

  /// Taken from the hand in this contact and not given back, as far as it is known.
  double left_J() const noexcept { return left_J_; }
  /// On the grip, as far as it is known.
  const Eigen::Vector3d& force_N() const noexcept { return force_N_; }

 private:
  static constexpr int kSlope = 3;  // ticks over which the acceleration is measured

  double left_J_ = 0;
  std::array<Eigen::Vector3d, kSlope + 1> velocity_m_s_ = zeros();  // the latest first
  Eigen::Vector3d limited_N_ =
      Eigen::Vector3d::Zero();                          // by the path's limits, with what is beside
  Eigen::Vector3d beside_N_ = Eigen::Vector3d::Zero();  // by the same limits, alone
  Eigen::Vector3d force_N_ = Eigen::Vector3d::Zero();   // on the grip, at the end of the last tick
  Eigen::Vector3d mean_N_ = Eigen::Vector3d::Zero();    // in the last tick, not yet measured
  Eigen::Vector3d before_N_ = Eigen::Vector3d::Zero();  // in the tick before

  static std::array<Eigen::Vector3d, kSlope + 1> zeros() {
    std::array<Eigen::Vector3d, kSlope + 1> all;
    all.fill(Eigen::Vector3d::Zero());
    return all;
  }
};

}  // namespace spidar
