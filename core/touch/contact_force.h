// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The force of a grip that touches a relief.
#pragma once

#include <limits>

#include <Eigen/Core>

#include "core/api.h"
#include "core/touch/energy_budget.h"
#include "core/touch/moving_relief.h"
#include "core/touch/proxy.h"

namespace spidar {

/// See docs/touch.md for why these are stable.
struct ContactSettings {
  double stiffness_N_m = 500;  ///< above 0, at most kMostStiffness_N_m
  /// From a motion of the grip to the force that answers it: half a tick of holding, a tick because
  /// the pose is that of the last exchange, and the lag of the drive (2 ms where it is not known).
  double delay_s = 0.0035;  ///< finite and ≥ 0
  /// The damping B, in units of stiffness · delay. Finite and ≥ 1: below, the delay puts out more
  /// energy than the damping takes, at every frequency.
  double damping = 1.5;
  double lateral_damping = 0.5;  ///< along the surface, in units of B; finite and ≥ 0.5
  Friction friction;
  double texture = 1;  ///< of the slope of the texture that is felt; finite and ≥ 0
  /// What the safety chain lets through: a contact gives no more energy back than it took only if
  /// these are right. Above 0; the force may be infinite.
  double max_force_N = std::numeric_limits<double>::infinity();
  double max_slew_N_s = 300;
  /// Felt at the same time and not from the contact, as the film's; it shares those two limits.
  Eigen::Vector3d beside_N = Eigen::Vector3d::Zero();
  /// Of the grip alone. A lighter one can get some energy out of a fast tap. Finite and above 0.
  double least_mass_kg = 0.05;
  bool bounds_energy = true;  ///< false, in measurements: without EnergyBudget

  static constexpr double kMostStiffness_N_m = 800;

  double damping_N_s_m() const noexcept { return damping * stiffness_N_m * delay_s; }
};

/// Throws std::invalid_argument that names the setting which is out of range.
SPIDAR_API void validate(const ContactSettings& settings);

/// A spring to the proxy, a damper, and the texture as a force along the surface, together no more
/// than what EnergyBudget allows. Fine texture as part of the relief would let the proxy snap from
/// valley to valley.
class SPIDAR_API ContactForce {
 public:
  /// Cutoff of the velocity, a first-order low-pass.
  static constexpr double kVelocityCutoff_Hz = 60;
  /// The texture's force is at most this share of the force across the surface, of which no more
  /// than kMostTexture_N counts: it is a spring along the surface, and this bounds its stiffness.
  static constexpr double kMostTextureSlope = 0.15;
  static constexpr double kMostTexture_N = 1;

  /// Force on the grip, device frame, `dt_s` > 0 after the last tick. Zero where it does not touch,
  /// and never towards the inside. `texture`: heights whose slope is felt, or null. Settings have
  /// to be valid. Neither allocates nor throws.
  Eigen::Vector3d tick(const MovingRelief& surface, const HeightField* texture,
                       const ContactSettings& settings, const Eigen::Vector3d& grip_m,
                       double dt_s) noexcept;

  const TouchProxy& proxy() const noexcept { return proxy_; }
  /// The pose was lost: nothing is known about how the grip moves.
  void reset() noexcept { *this = {}; }

 private:
  void follow(const Eigen::Vector3d& grip_m, double dt_s) noexcept;
  Eigen::Vector3d wanted_N(const HeightField* texture, const ContactSettings& settings,
                           const Eigen::Vector3d& grip_m) const noexcept;
  double bounded_share(const Eigen::Vector3d& wanted_N, const ForcePath& path,
                       double dt_s) noexcept;
  void follow_energy(const ContactSettings& settings, const Eigen::Vector3d& way_m,
                     const Eigen::Vector3d& grip_m) noexcept;

  TouchProxy proxy_;
  EnergyBudget budget_;
  double bounded_N_ = std::numeric_limits<double>::infinity();  ///< in the last tick, if it was
  bool started_ = false;
  Eigen::Vector3d last_m_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity_m_s_ = Eigen::Vector3d::Zero();
};

}  // namespace spidar
