// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <limits>

#include <Eigen/Core>

#include "core/touch/energy_budget.h"
#include "core/touch/proxy.h"

namespace spidar::touch {

/// docs/strings.md explains why these values are stable.
struct ContactSettings {
  double stiffness_N_m = 500;  ///< above 0, at most kMaxStiffness_N_m
  /// Delay from a motion of the grip to the resulting force: half a tick for the zero-order hold, a
  /// tick because the pose comes from the last exchange, and the lag of the drive (2 ms if
  /// unknown).
  double delay_s = 0.0035;  ///< finite and ≥ 0
  /// The damping B, in units of stiffness · delay. Finite and ≥ 1: below 1 the delay generates more
  /// energy than the damping dissipates, at every frequency.
  double damping = 1.5;
  double lateral_damping = 0.5;  ///< along the surface, in units of B; finite and ≥ 0.5
  double friction = 0;           ///< coefficient of static Coulomb friction; finite and ≥ 0
  double texture = 1;            ///< gain of the texture's slope; finite and ≥ 0
  /// Limits of the safety chain. The contact stays passive only if they are correct. Above 0;
  /// max_force_N may be infinite.
  double max_force_N = std::numeric_limits<double>::infinity();
  double max_slew_N_s = 300;
  /// A force that the device exerts at the same time but that does not come from the contact, such
  /// as the film's. The two limits above hold for the sum.
  Eigen::Vector3d beside_N = Eigen::Vector3d::Zero();
  /// Mass of the grip alone, finite and above 0. A lighter grip can gain energy in a fast tap.
  double least_mass_kg = 0.05;

  static constexpr double kMaxStiffness_N_m = 800;

  double damping_N_s_m() const noexcept { return damping * stiffness_N_m * delay_s; }
};

/// Throws std::invalid_argument, which names the setting that is out of range.
void validate(const ContactSettings& settings);

/// The contact force on a grip that touches a relief: the sum of a spring to the proxy, a damper,
/// and the texture as a force along the surface, bounded by EnergyBudget. The texture is not part
/// of the relief because the proxy would then snap from valley to valley.
class ContactForce {
 public:
  /// Cutoff frequency of the first-order low-pass on the velocity.
  static constexpr double kVelocityCutoff_Hz = 60;
  /// The texture force is at most kMaxTextureSlope times the normal force, which counts up to
  /// kMaxTexture_N. This bounds the texture's stiffness as a spring along the surface.
  static constexpr double kMaxTextureSlope = 0.15;
  static constexpr double kMaxTexture_N = 1;

  /// Returns the force on the grip in the device frame, `dt_s` > 0 after the last tick. `grip_m` is
  /// the position of the grip in the exchange of the last tick. The force is zero without contact
  /// and never pulls the grip into the surface. `texture` holds heights whose slope becomes a
  /// force, or is null. The settings must be valid. Neither allocates nor throws.
  Eigen::Vector3d tick(const MovingRelief& surface, const HeightField* texture,
                       const ContactSettings& settings, const Eigen::Vector3d& grip_m,
                       double dt_s) noexcept;

  /// Call this after tick(): see EnergyBudget.
  void set_delivered(const Wrench& given, const Eigen::Vector3d& turn_rad) noexcept {
    budget_.set_delivered(given, turn_rad);
  }

  const Eigen::Vector3d& velocity_m_s() const noexcept { return velocity_m_s_; }
  const Proxy& proxy() const noexcept { return proxy_; }
  /// Discards all state, for example after the pose was lost.
  void reset() noexcept { *this = {}; }

 private:
  void follow(const Eigen::Vector3d& grip_m, double dt_s) noexcept;
  Eigen::Vector3d wanted_N(const HeightField* texture, const ContactSettings& settings,
                           const Eigen::Vector3d& grip_m) const noexcept;
  void follow_energy(const ContactSettings& settings, const Eigen::Vector3d& moved_m,
                     const Eigen::Vector3d& grip_m) noexcept;

  Proxy proxy_;
  EnergyBudget budget_;
  bool started_ = false;
  double before_s_ = 0;  ///< dt_s of the last tick
  Eigen::Vector3d last_m_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity_m_s_ = Eigen::Vector3d::Zero();
};

}  // namespace spidar::touch
