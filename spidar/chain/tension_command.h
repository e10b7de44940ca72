// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Converts the commanded wrench to the volts of each motor: tensions, the bound of their change,
/// and the heat of the windings. None of it allocates, locks or throws.
#pragma once

#include <algorithm>
#include <utility>

#include "core/grip/string_geometry.h"
#include "core/grip/tension_solver.h"
#include "core/wrench.h"
#include "spidar/device.h"
#include "spidar/grip/grip.h"
#include "spidar/grip/grip_motion.h"
#include "spidar/profiles/profile.h"

namespace spidar {

/// An I²t model: the tension of a motor is proportional to its current, and the heat to the square
/// of the current. Each motor is modelled as a body with one time constant. Heat 1 is the final
/// value when the motor produces its continuous tension indefinitely. Nothing is measured; the
/// motors are assumed to be cold when this object is created.
class MotorHeat {
 public:
  /// From this heat on, the limit of a motor falls from its largest tension, down to its continuous
  /// tension at heat 1. No sequence of tensions within limit_N() raises the heat above 1.
  static constexpr double kLimitFrom = 0.8;

  explicit MotorHeat(const Profile& profile) : profile_(profile) {
    // A profile that was not read from a file may lack the continuous tension.
    for (StringDrive& drive : profile_.drives) {
      if (!(drive.continuous_tension_N > 0)) drive.continuous_tension_N = drive.max_tension_N / 2;
    }
  }

  /// Updates the heat for motors that have produced `tension_N` for `dt_s`.
  void update(const StringVector& tension_N, double dt_s) noexcept {
    for (int i = 0; i < profile_.geometry.count; ++i) {
      const StringDrive& drive = profile_.drives[static_cast<size_t>(i)];
      const double load = tension_N[i] / drive.continuous_tension_N;
      heat_[i] += (load * load - heat_[i]) * std::clamp(dt_s / drive.heating_time_s, 0.0, 1.0);
    }
  }

  /// The largest permitted tension of each string at its present heat, N.
  StringVector limit_N() const noexcept {
    StringVector limit_N = StringVector::Zero();
    for (int i = 0; i < profile_.geometry.count; ++i) {
      const StringDrive& drive = profile_.drives[static_cast<size_t>(i)];
      const double room = std::clamp((1 - heat_[i]) / (1 - kLimitFrom), 0.0, 1.0);
      const double continuous_N = drive.continuous_tension_N;
      limit_N[i] = continuous_N + room * (drive.max_tension_N - continuous_N);
    }
    return limit_N;
  }

  double hottest() const noexcept { return heat_.head(profile_.geometry.count).maxCoeff(); }

 private:
  Profile profile_;
  StringVector heat_ = StringVector::Zero();
};

/// Bounds the change of tensions per second. At the border of the wrench-closure workspace, the
/// solution moves nearly the whole tension from some strings to others within a tick
/// (docs/strings.md). A hand would feel that as a jerk, and a motor cannot follow it.
class TensionSlew {
 public:
  /// The shortest time in which a string passes through its whole range, unless the range is small.
  static constexpr double kRange_s = 0.02;
  /// A limit on the change of tensions below this would delay a wrench, which may change as fast as
  /// SafetyLimits permit: weak motors need all of their range for a few newtons. A force that the
  /// brake takes away would then continue to accelerate the grip.
  static constexpr double kMin_N_s = 300;

  static double pace_N_s(const StringDrive& drive) noexcept {
    return std::max(kMin_N_s, (drive.max_tension_N - drive.min_tension_N) / kRange_s);
  }

  explicit TensionSlew(const Profile& profile) { reset(profile); }

  /// All strings make the same fraction of their step, so that no bound is exceeded and the wrench
  /// lies between the previous and the wanted one. NaN counts as the minimum.
  StringVector apply(const StringVector& tension_N, const Profile& profile, double dt_s) noexcept;

  /// Starts at rest, where every string has its minimum tension.
  void reset(const Profile& profile) noexcept { last_N_ = profile.min_tension_N(); }

  /// Continues from `tension_N`, the tensions that the device has acknowledged.
  void reset(const StringVector& tension_N) noexcept { last_N_ = tension_N; }

 private:
  StringVector last_N_;
};

/// Limits tensions to the range from zero to each string's largest. NaN becomes zero.
StringVector bound_tensions(const StringVector& tension_N, const Profile& profile) noexcept;

/// Converts tensions to D/A volts with newtons_per_volt and motor_sign, clamped to the D/A range.
MotorVolts to_volts(const StringVector& tension_N, const Profile& profile) noexcept;

/// At rest, every string has its minimum tension, whatever the pose, because strings that pull
/// against each other give a zero wrench only if the assumed pose is right. With a wanted wrench,
/// the tensions may rise in proportion to its magnitude, so that they do not jump between rest and
/// a wrench. No function allocates or throws.
class TensionCommand {
 public:
  /// The limit of each string's tension above its minimum, for each newton of the wrench (torque is
  /// divided by the grip radius). A higher limit does not deliver noticeably more of the wrench
  /// within 2 cm and 20°, and increases the error of the force if the assumed pose is wrong
  /// (docs/strings.md).
  static constexpr double kTensionPerForce = 4;

  /// Two ticks: one until the next exchange, and one more if that exchange is late.
  static constexpr double kAhead_s = 2e-3;
  /// The strings cannot exert every force without a torque. Least squares leaves a torque whose
  /// lever is 0.3 to 0.6 of the grip's radius within 2 cm and 20°; this is the lever that limit()
  /// assumes. A torque up to this lever times the force limit never counts as above the torque
  /// limit, because only a smaller force would reduce that torque.
  static constexpr double kStrayLever = 0.5;

  /// The pace of fade() when the pose is lost: a string may have broken, and the others pull with
  /// up to three times the force until they are at rest. A ramp of 40 ms becomes one of 13 ms, as
  /// fast as the tensions of spidar-g6c may fall from 13 N.
  static constexpr double kLostPace = 4;

  explicit TensionCommand(const Profile& profile);

  /// Returns the tensions that approximate `wrench` best, with the structure matrix `W` of a
  /// trusted pose. A wrench of zero is rest. No tension exceeds `limit_N`.
  ///
  /// Away from the centre the tensions at rest pull the grip back a little. That pull stays, and
  /// `wrench` is added to it, because the pull generates energy as soon as something removes it and
  /// restores it elsewhere. It does not stay while a string is left out.
  StringVector solve(const StructureMatrix& W, const Wrench& wrench,
                     const StringVector& limit_N) noexcept;

  /// Reduces what the tensions of the last solve() add to those at rest until force and torque are
  /// within `limits`, and returns the tensions. Least squares may overshoot, and the wrench at rest
  /// is added. `W` is that of `pose`. The tensions act while the grip moves on with `motion`, and
  /// decay with the lag of the drives. The limits therefore hold also at the pose that is reached
  /// in kAhead_s and two time constants of the drives, when an eighth of the tensions is left.
  ///
  /// If the force at rest alone exceeds the limit, the command does not increase the force. A
  /// torque limit below the sum of the torque at rest and that of kStrayLever counts as that sum,
  /// because a torque limit of zero must not remove the force. In every profile, the sum is below
  /// the default limit.
  StringVector limit(const StructureMatrix& W, const SafetyLimits& limits, const Pose& pose,
                     const GripMotion& motion) noexcept;

  /// Returns the tensions for a tick without a wanted wrench or a known pose: they approach rest in
  /// proportion as `wrench` falls from the wrench of the last solve() to zero. Needs no W. With a
  /// `pace` of 4, they are at rest after a quarter of the ramp.
  StringVector fade(const Wrench& wrench, double pace = 1) noexcept;
  /// Call this before fade(): after a solve(), the fade begins at the present tensions. A tension
  /// that has not reached the solution yet would rise otherwise.
  void begin_fade(const StringVector& tension_N) noexcept {
    if (!std::exchange(fades_, true)) last_N_ = tension_N;
  }

  /// From now on, does not use a string that is broken or slack or whose encoder is dead. As the
  /// fraction of the wrench that is used grows, the tension of that string decreases from the
  /// minimum to zero. At rest the string keeps its minimum tension like the others, because it may
  /// not really be broken, and then seven strings would pull the grip aside. −1: none.
  void exclude(int string) noexcept { left_out_ = string; }

  /// The fraction of the wrench that the last solve() used. It is below 1 if a string is left out
  /// or limited, because the other strings alone would give a different wrench.
  double fraction() const noexcept { return fraction_; }
  bool held_back() const noexcept { return fraction_ < 1; }

  void reset() noexcept;

 private:
  /// Sets the wrench of the problem and the corresponding bounds. Returns the fraction of their
  /// range that strings may not use, 0 … 1.
  double pose_problem(const Wrench& wrench, const StringVector& limit_N) noexcept;

  /// The fraction, 0 … 1, of the tensions added by the last solve() that is within `limits` at a
  /// pose with the structure matrix `W`.
  double fraction_within(const StructureMatrix& W, const SafetyLimits& limits) const noexcept;
  /// Whether the last solve() is within `limits` at all poses that are reached from `pose` when no
  /// point of the grip moves by more than `moved_m`. Returns false when the bound cannot tell.
  bool stays_within(const StructureMatrix& W, const SafetyLimits& limits, const Pose& pose,
                    double moved_m) const noexcept;
  double stray_Nm(const SafetyLimits& limits) const noexcept;

  const StringGeometry geometry_;
  const double ahead_s_;
  double reach_m_ = 0;     ///< distance of the farthest point of the grip
  double shortest_m_ = 0;  ///< length of the shortest string at the centre
  const StringVector min_N_;
  const StringVector max_N_;
  TensionProblem problem_;
  TensionSolver solver_;
  int left_out_ = -1;
  bool fades_ = true;    ///< no solve() since the last fade
  StringVector last_N_;  ///< tensions of the last solve()
  double last_size_N_ = 0;
  double fraction_ = 1;
};

}  // namespace spidar
