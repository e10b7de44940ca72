// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The physics of a simulated SPIDAR: a rigid grip pulled by strings and a hand.
#pragma once

#include <Eigen/Core>

#include "core/grip/pose.h"
#include "core/grip/string_geometry.h"
#include "core/wrench.h"

namespace spidar {

/// Rigid grip on strings, held by a hand. The hand carries the grip's weight.
struct GripModel {
  double mass_kg = 0.10;
  double inertia_kg_m2 = 4e-5;        ///< solid sphere of that mass and 32 mm radius
  double hand_stiffness_N_m = 300.0;  ///< relaxed grasp
  double hand_damping_N_s_m = 8.0;
  double hand_stiffness_Nm_rad = 1.5;
  double hand_damping_Nm_s_rad = 0.02;
  double motor_time_constant_s = 0.002;  ///< first-order lag from volts to tension
  double motor_delay_s = 0;  ///< pure delay before that, at most kMostDelay_s; of SimulatedDevice

  static constexpr double kMostDelay_s = 0.05;
};

struct GripState {
  Pose pose;
  Eigen::Vector3d velocity_m_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_velocity_rad_s = Eigen::Vector3d::Zero();  ///< in D
  StringVector tension_N = StringVector::Zero();
};

/// Newton–Euler equations of the grip, integrated by the semi-implicit Euler method with implicit
/// dampers. All forces are in D; the inertia is a sphere's, so there is no gyroscopic term.
class GripDynamics {
 public:
  /// `max_tension_N` bounds the tensions that advance() will be given; the step follows from it.
  /// Throws std::invalid_argument when the model is not physical (mass and inertia above zero, the
  /// rest not negative, all finite) or so stiff that a millisecond takes more than kMaxSubsteps.
  GripDynamics(const StringGeometry& geometry, const StringVector& max_tension_N,
               const GripModel& model);

  static constexpr int kMaxSubsteps = 1000;

  /// Moves `state` on by `dt_s` ≥ 0. Tensions follow `target_N` with the motors' lag. The hand's
  /// springs pull towards `hand`; its dampers act against the grip's own velocity, because only
  /// the position of the hand is given. The grip's origin stays within limit_m() of the
  /// centre: at the limit it stops, losing its outward velocity.
  void advance(const StringVector& target_N, const Pose& hand, double dt_s,
               GripState& state) const noexcept;

  /// Wrench of the strings on the grip.
  Wrench string_wrench(const GripState& state) const noexcept;

  /// Longest substep, seconds.
  double max_step_s() const noexcept { return max_step_s_; }

  /// Half of the box that the exits span, per axis.
  const Eigen::Vector3d& limit_m() const noexcept { return limit_m_; }

 private:
  void substep(const StringVector& target_N, const Pose& hand, double h_s, double lag_decay,
               GripState& state) const noexcept;

  StringGeometry geometry_;
  GripModel model_;
  Eigen::Vector3d limit_m_;
  double max_step_s_ = 0;
};

/// Rotation vector of `rotation`, in radians, with an angle of at most π.
Eigen::Vector3d rotation_vector(const Eigen::Quaterniond& rotation) noexcept;

}  // namespace spidar
