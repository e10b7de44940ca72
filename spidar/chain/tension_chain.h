// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// From the commanded wrench to the tension of each string: limits that protect the motors, and
/// limits of what the strings add.
#pragma once

#include <array>

#include "core/grip/string_geometry.h"
#include "spidar/chain/tension_command.h"
#include "spidar/grip/grip.h"
#include "spidar/grip/grip_motion.h"
#include "spidar/profiles/profile.h"

namespace spidar {

/// The limits of tensions, with their state. Nothing allocates, locks or throws.
class TensionChain {
 public:
  struct Tick {
    const GripCommand& command;
    const StructureMatrix& W;  ///< structure matrix at `pose`
    const Pose& pose;
    const GripMotion& motion;
    bool trusted;  ///< whether the pose is trusted
    int left_out;  ///< string that is broken or slack; −1: none
  };
  /// One step; `function` returns the limited tensions. The chain runs the steps in the order of
  /// kSteps, and docs/architecture.md has the same list (test `limit_chain`).
  struct Step {
    const char* name;
    const char* limit;
    const char* reason;  ///< why the limit exists, or why it has this place
    StringVector (TensionChain::*function)(const StringVector&, const Tick&) noexcept;
  };
  static const std::array<Step, 6> kSteps;

  explicit TensionChain(const Profile& profile)
      : profile_(profile), command_(profile), slew_(profile), heat_(profile) {}

  /// Passes the command of `tick` through all steps.
  StringVector apply(const Tick& tick) noexcept;
  /// Call this when the motors have received `tension_N`, the result of the last apply().
  void acknowledge(const StringVector& tension_N) noexcept { acknowledged_N_ = tension_N; }
  /// Call this when the motors may not have received it. Returns the last acknowledged tensions.
  const StringVector& undo() noexcept {
    slew_.reset(acknowledged_N_);
    return acknowledged_N_;
  }
  /// Heats the motors with the acknowledged tensions for `passed_s`.
  void heat(double passed_s) noexcept { heat_.update(acknowledged_N_, passed_s); }
  /// Starts with motors that are off; their heat is kept.
  void reset() noexcept;

  double hottest() const noexcept { return heat_.hottest(); }
  /// Whether the strings give less than the command, because one is left out or a motor is warm.
  bool held_back() const noexcept { return command_.held_back(); }

 private:
  StringVector strings(const StringVector& tension_N, const Tick& tick) noexcept;
  StringVector delivered(const StringVector& tension_N, const Tick& tick) noexcept;
  StringVector push(const StringVector& tension_N, const Tick& tick) noexcept;
  StringVector power(const StringVector& tension_N, const Tick& tick) noexcept;
  StringVector pace(const StringVector& tension_N, const Tick& tick) noexcept;
  StringVector range(const StringVector& tension_N, const Tick& tick) noexcept;

  const Profile profile_;
  TensionCommand command_;
  TensionSlew slew_;
  MotorHeat heat_;
  StringVector acknowledged_N_ = StringVector::Zero();  ///< tensions of the last answered command
};

}  // namespace spidar
