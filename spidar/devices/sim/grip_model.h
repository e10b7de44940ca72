// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The mechanics of a simulated SPIDAR: drives, grip, and the hand that holds it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include "core/grip/string_geometry.h"
#include "core/wrench.h"

namespace spidar {

/// A rigid grip on strings, held by a hand that carries the weight of the grip.
struct GripModel {
  double mass_kg = 0.10;
  double inertia_kg_m2 = 4e-5;        ///< solid sphere of that mass and 32 mm radius
  double hand_stiffness_N_m = 300.0;  ///< relaxed grasp
  double hand_damping_N_s_m = 8.0;
  double hand_stiffness_Nm_rad = 1.5;
  double hand_damping_Nm_s_rad = 0.02;
  double motor_time_constant_s = 0.002;  ///< first-order lag from volts to tension
  /// Delay before that lag, at most kMaxDelay_s; only SimulatedDevice has it.
  double motor_delay_s = 0;

  static constexpr double kMaxDelay_s = 0.05;
};

/// Newton–Euler equations of the grip, integrated by the semi-implicit Euler method with implicit
/// dampers. All forces are in D; the inertia is a sphere's, so there is no gyroscopic term.
class GripDynamics {
 public:
  struct State {
    Pose pose;
    Eigen::Vector3d velocity_m_s = Eigen::Vector3d::Zero();
    Eigen::Vector3d angular_velocity_rad_s = Eigen::Vector3d::Zero();  ///< in D
    StringVector tension_N = StringVector::Zero();
  };

  /// `max_tension_N` bounds the tensions of advance(), and determines the step. Throws
  /// std::invalid_argument when the model is not physical (mass and inertia above zero, the rest
  /// not negative, all finite) or so stiff that a millisecond takes more than kMaxSubsteps.
  GripDynamics(const StringGeometry& geometry, const StringVector& max_tension_N,
               const GripModel& model);

  static constexpr int kMaxSubsteps = 1000;

  /// Advances `state` by `dt_s` ≥ 0. Tensions follow `target_N` with the motors' lag. The hand's
  /// springs pull towards `hand`; its dampers act against the grip's own velocity, because the hand
  /// has only a position. The grip's origin stays within limit_m() of the centre, where it loses
  /// its outward velocity.
  void advance(const StringVector& target_N, const Pose& hand, double dt_s,
               State& state) const noexcept;

  Wrench string_wrench(const State& state) const noexcept;

  /// Longest substep, seconds.
  double max_step_s() const noexcept { return max_step_s_; }

  /// Half of the box that the exits span, per axis.
  const Eigen::Vector3d& limit_m() const noexcept { return limit_m_; }

 private:
  void substep(const StringVector& target_N, const Pose& hand, double h_s, double lag_decay,
               State& state) const noexcept;

  StringGeometry geometry_;
  GripModel model_;
  Eigen::Vector3d limit_m_;
  double max_step_s_ = 0;
};

/// Rotation vector of `rotation`, in radians, with an angle of at most π.
Eigen::Vector3d rotation_vector(const Eigen::Quaterniond& rotation) noexcept;

/// A pure delay, such as that of a board with amplifiers and packets. Fixed size, no allocation.
class DelayedTensions {
 public:
  /// At one command per millisecond, a delay of 50 ms holds 50 commands.
  static constexpr size_t kCapacity = 64;

  /// Adds a command at `time_ns`, which must not decrease; the command takes effect at `time_ns` +
  /// `delay_ns`. When the queue is full, the oldest command takes effect early.
  void push(int64_t time_ns, int64_t delay_ns, const StringVector& tension_N) noexcept {
    if (count_ == kCapacity) drop();
    waiting_[(first_ + count_++) % kCapacity] = {time_ns + delay_ns, tension_N};
  }

  /// Returns the tensions in effect at `now_ns`.
  const StringVector& at(int64_t now_ns) noexcept {
    while (count_ > 0 && waiting_[first_].from_ns <= now_ns) drop();
    return acting_N_;
  }

  /// Returns the time of the next change after at(); INT64_MAX when no command is pending.
  int64_t next_ns() const noexcept { return count_ > 0 ? waiting_[first_].from_ns : INT64_MAX; }

  /// Discards all commands and sets the tensions to zero.
  void clear() noexcept { *this = {}; }

 private:
  struct Waiting {
    int64_t from_ns = 0;
    StringVector tension_N = StringVector::Zero();
  };

  void drop() noexcept {
    acting_N_ = waiting_[first_].tension_N;
    first_ = (first_ + 1) % kCapacity;
    --count_;
  }

  std::array<Waiting, kCapacity> waiting_{};
  size_t first_ = 0;
  size_t count_ = 0;
  StringVector acting_N_ = StringVector::Zero();
};

/// Moves the hand towards its target at a limited speed. Without a target the hand returns to its
/// resting pose, and then stays exactly there.
class GuidedHand {
 public:
  /// The speed of a brisk stroke. People explore surfaces at 0.01 … 0.25 m/s (R. Klatzky and S.
  /// Lederman, Tactile roughness perception with a rigid link interposed between skin and surface,
  /// Perception & Psychophysics 61, 1999), and reach faster.
  static constexpr double kFastest_m_s = 0.5;

  /// Returns the pose of the hand `dt_s` ≥ 0 later, on its way to `to_m` in the device frame, or to
  /// `rest`. Neither allocates nor throws.
  const Pose& advance(const Pose& rest, const std::optional<Eigen::Vector3d>& to_m,
                      double dt_s) noexcept;

 private:
  bool away_ = false;  ///< whether the hand is away from its resting pose
  Pose pose_;
};

}  // namespace spidar
