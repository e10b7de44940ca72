// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/devices/sim/grip_model.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace spidar {
namespace {

/// Step times the highest angular frequency. The method is stable below 2, so the strings'
/// stiffness t/L may still grow 64-fold: a string may shorten to 1/64 of its length at the centre.
constexpr double kStepTimesFrequency = 0.25;
constexpr double kLongestStep_s = 1e-3;

void check(double value, bool zero_allowed, const char* field) {
  if (std::isfinite(value) && (value > 0 || (zero_allowed && value == 0))) return;
  throw std::invalid_argument(std::string("GripModel::") + field + " is " + std::to_string(value) +
                              ", must be finite and " +
                              (zero_allowed ? "not negative" : "above zero"));
}

void check(const GripModel& model) {
  check(model.mass_kg, false, "mass_kg");
  check(model.inertia_kg_m2, false, "inertia_kg_m2");
  check(model.hand_stiffness_N_m, true, "hand_stiffness_N_m");
  check(model.hand_damping_N_s_m, true, "hand_damping_N_s_m");
  check(model.hand_stiffness_Nm_rad, true, "hand_stiffness_Nm_rad");
  check(model.hand_damping_Nm_s_rad, true, "hand_damping_Nm_s_rad");
  check(model.motor_time_constant_s, true, "motor_time_constant_s");
  check(model.motor_delay_s, true, "motor_delay_s");
  if (model.motor_delay_s > GripModel::kMaxDelay_s) {
    throw std::invalid_argument("GripModel::motor_delay_s is " +
                                std::to_string(model.motor_delay_s) + ", must be at most " +
                                std::to_string(GripModel::kMaxDelay_s));
  }
}

/// Upper bound of the largest eigenvalue of M⁻¹K at the centre, rad²/s².
///
/// A string of constant tension t, length L and arm r has the stiffness (t/L) Jᵀ(I − uuᵀ)J plus at
/// most t·r about the grip's origin (the arm turns), J = [I, −[r]×]. Scaled by mass m and inertia
/// I, JᵀJ is at most 1/m + r²/I, so a string adds t ((1/m + r²/I)/L + r/I). The hand's springs act
/// on translation and rotation separately and add the larger of K/m and K_r/I.
double max_frequency_squared(const StringGeometry& geometry, const StringVector& max_tension_N,
                             const GripModel& model) {
  const double per_mass = 1 / model.mass_kg;
  const double per_inertia = 1 / model.inertia_kg_m2;
  double bound =
      std::max(model.hand_stiffness_N_m * per_mass, model.hand_stiffness_Nm_rad * per_inertia);
  const StringVector length_m = string_lengths_m(geometry, {});
  for (int i = 0; i < geometry.count; ++i) {
    const double arm_m = geometry.grip_m[static_cast<size_t>(i)].norm();
    bound += max_tension_N[i] *
             ((per_mass + arm_m * arm_m * per_inertia) / length_m[i] + arm_m * per_inertia);
  }
  return bound;
}

Eigen::Quaterniond rotation_by(const Eigen::Vector3d& vector_rad) {
  const double angle = vector_rad.norm();
  // sin(a/2)/a, or its limit for small a.
  const double scale = angle > 1e-8 ? std::sin(angle / 2) / angle : 0.5;
  Eigen::Quaterniond rotation;
  rotation.w() = std::cos(angle / 2);
  rotation.vec() = scale * vector_rad;
  return rotation;
}

}  // namespace

Eigen::Vector3d rotation_vector(const Eigen::Quaterniond& rotation) noexcept {
  const double sine = rotation.vec().norm();
  const double sign = rotation.w() < 0 ? -1.0 : 1.0;
  // angle / sin(angle/2), or its limit for zero rotation.
  const double scale = sine > 1e-8 ? 2 * std::atan2(sine, sign * rotation.w()) / sine : 2.0;
  return sign * scale * rotation.vec();
}

GripDynamics::GripDynamics(const StringGeometry& geometry, const StringVector& max_tension_N,
                           const GripModel& model)
    : geometry_(geometry), model_(model), limit_m_(half_frame_m(geometry)) {
  check(model);
  const double frequency = std::sqrt(max_frequency_squared(geometry, max_tension_N, model));
  max_step_s_ =
      frequency > 0 ? std::min(kLongestStep_s, kStepTimesFrequency / frequency) : kLongestStep_s;
  if (kLongestStep_s / max_step_s_ > kMaxSubsteps) {
    throw std::invalid_argument(
        "GripModel is too stiff for its mass: " + std::to_string(frequency) +
        " rad/s, must be below " +
        std::to_string(kStepTimesFrequency * kMaxSubsteps / kLongestStep_s) +
        "; use softer springs or a heavier grip");
  }
}

// With β = h b/m and κ = h² k/m one step of a mode is x⁺ = x + y⁺, y⁺ = (y − κ x)/(1 + β) where y =
// h v. The eigenvalues are inside the unit circle when κ < 4 + 2β (Jury): damping always improves
// stability, and h ω < 2 is sufficient.
void GripDynamics::substep(const StringVector& target_N, const Pose& hand, double h_s,
                           double lag_decay, GripDynamics::State& state) const noexcept {
  state.tension_N = target_N + lag_decay * (state.tension_N - target_N);
  const Wrench strings = string_wrench(state);

  const Eigen::Vector3d force_N =
      strings.force_N + model_.hand_stiffness_N_m * (hand.position_m - state.pose.position_m);
  state.velocity_m_s = (state.velocity_m_s + h_s / model_.mass_kg * force_N) /
                       (1 + h_s * model_.hand_damping_N_s_m / model_.mass_kg);

  const Eigen::Vector3d torque_Nm =
      strings.torque_Nm +
      model_.hand_stiffness_Nm_rad *
          rotation_vector(hand.orientation * state.pose.orientation.conjugate());
  state.angular_velocity_rad_s =
      (state.angular_velocity_rad_s + h_s / model_.inertia_kg_m2 * torque_Nm) /
      (1 + h_s * model_.hand_damping_Nm_s_rad / model_.inertia_kg_m2);

  state.pose.position_m += h_s * state.velocity_m_s;
  state.pose.orientation =
      (rotation_by(h_s * state.angular_velocity_rad_s) * state.pose.orientation).normalized();

  for (int axis = 0; axis < 3; ++axis) {
    double& x = state.pose.position_m[axis];
    double& v = state.velocity_m_s[axis];
    if (std::abs(x) <= limit_m_[axis]) continue;
    x = std::copysign(limit_m_[axis], x);
    if (x * v > 0) v = 0;
  }
}

void GripDynamics::advance(const StringVector& target_N, const Pose& hand, double dt_s,
                           GripDynamics::State& state) const noexcept {
  if (!(dt_s > 0)) return;
  const int steps = std::max(1, static_cast<int>(std::ceil(dt_s / max_step_s_)));
  const double h_s = dt_s / steps;
  const double lag_decay =
      model_.motor_time_constant_s > 0 ? std::exp(-h_s / model_.motor_time_constant_s) : 0.0;
  for (int i = 0; i < steps; ++i) substep(target_N, hand, h_s, lag_decay, state);
}

Wrench GripDynamics::string_wrench(const GripDynamics::State& state) const noexcept {
  const Eigen::Matrix<double, 6, 1> wrench =
      structure_matrix(geometry_, state.pose) * state.tension_N;
  return {wrench.head<3>(), wrench.tail<3>()};
}

const Pose& GuidedHand::advance(const Pose& rest, const std::optional<Eigen::Vector3d>& to_m,
                                double dt_s) noexcept {
  if (!away_) pose_ = rest;
  if (!away_ && !to_m) return pose_;
  const Eigen::Vector3d to_go_m = to_m.value_or(rest.position_m) - pose_.position_m;
  const double most_m = kFastest_m_s * dt_s;
  const double length_m = to_go_m.norm();
  away_ = to_m || length_m > most_m;
  pose_.orientation = rest.orientation;
  if (length_m > most_m) {
    pose_.position_m += most_m / length_m * to_go_m;
  } else {
    pose_.position_m += to_go_m;
  }
  return pose_;
}

}  // namespace spidar
