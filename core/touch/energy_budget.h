// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <limits>
#include <optional>

#include <Eigen/Core>

#include "core/history.h"
#include "core/wrench.h"

namespace spidar::touch {

/// Properties of the path from a requested force to the motion of the grip.
struct ForcePath {
  double max_force_N = std::numeric_limits<double>::infinity();  ///< of the safety chain
  double max_slew_N_s = 300;                                     ///< of the safety chain
  double lag_s = 0.002;             ///< first-order lag of the drive; ≥ 0
  double velocity_lag_s = 0.00615;  ///< from a measured velocity to the resulting force
  double least_mass_kg = 0.05;      ///< of the grip and what moves with it
  /// How long a force is held until the next one. The next tick may be late.
  double tick_s = 0.001;
  double longest_tick_s = 0.002;  ///< the longest tick that counts in the safety chain's slew limit
};

/// Limits the energy that a contact returns to the hand: tracks the energy that the contact has
/// absorbed, and bounds the force so that the contact returns no more. It is a passivity observer
/// and controller (B. Hannaford and J.-H. Ryu, Time-domain passivity control of haptic interfaces,
/// IEEE Transactions on Robotics and Automation 18, 2002) that predicts. Observing the past is not
/// enough: a force with limited slew and a lag still pushes after the energy is spent.
///
/// A force F that is reduced from the next tick on at the slew limit still delivers the impulse J =
/// lag · (force on the grip) + F · tick + F² / (2 · slew). On a mass m that moves outwards at v,
/// this impulse does the work v J + J² / (2 m). The bound is the F for which this work equals the
/// energy that is left.
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

  /// Sets the force of this tick, before the limits of the path. `beside_N`, a force that does not
  /// come from the contact, shares these limits. The contact's part is the limited sum minus what
  /// would pass without the contact.
  void command(const Eigen::Vector3d& wanted_N, const Eigen::Vector3d& beside_N,
               const ForcePath& path, double dt_s) noexcept;

  /// Corrects the force of this tick: the device gives `given`, which may be less, point elsewhere
  /// and have a torque. Without this call, and beside another force, whose part is unknown, the
  /// device is assumed to give the command. The grip has turned by `turn_rad` since the last
  /// exchange.
  void set_delivered(const Wrench& given, const Eigen::Vector3d& turn_rad) noexcept;

  /// Estimated energy absorbed from the hand in this contact and not yet returned.
  double left_J() const noexcept { return left_J_; }
  const Eigen::Vector3d& force_N() const noexcept { return acting_.force_N; }

 private:
  void apply_lag(const Wrench& own) noexcept;

  // The number of ticks, if they are on time, over which the acceleration is measured.
  static constexpr int kSlope = 3;

  double left_J_ = 0;
  double bounded_N_ = std::numeric_limits<double>::infinity();  ///< infinite: it was not bounded
  // The direction of a smaller force is uncertain: the steps of a D/A converter are 5 mN.
  static constexpr double kKnownDirection_N = 0.05;
  // Short ticks follow a late one, so that more of them fit into the time of kSlope.
  static constexpr size_t kKept = 16;
  History<Eigen::Vector3d, kKept + 1> velocity_m_s_;
  History<double, kKept> dt_s_;  ///< of the last ticks, in which the velocity changed
  Eigen::Vector3d limited_N_ = Eigen::Vector3d::Zero();  ///< contact + beside, limited
  Eigen::Vector3d beside_N_ = Eigen::Vector3d::Zero();   ///< alone, with the same limits
  double fading_ = 0;     ///< the part of an earlier force that remains in the tick
  double lag_ticks_ = 0;  ///< the lag, in ticks
  Wrench begun_;          ///< on the grip, when the last tick began
  Wrench acting_;         ///< on the grip, at the end of the last tick
  Wrench mean_;           ///< in the last tick, not yet measured
  Eigen::Vector3d before_N_ = Eigen::Vector3d::Zero();   ///< in the tick before
  Eigen::Vector3d turned_Nm_ = Eigen::Vector3d::Zero();  ///< mean_.torque_Nm of the tick before
  std::optional<Eigen::Vector3d> given_;  ///< force on the grip for each newton of the contact's
};

}  // namespace spidar::touch
