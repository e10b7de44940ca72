// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The limits that protect the hand, in order, from the wanted wrench to the commanded one.
#pragma once

#include <array>
#include <cstdint>

#include "core/wrench.h"
#include "spidar/chain/grip_brake.h"
#include "spidar/grip/grip.h"
#include "spidar/limits/force_limits.h"
#include "spidar/limits/vibration_budget.h"
#include "spidar/limits/wrench_limits.h"

namespace spidar {

/// The limits of one tick. The loop owns the state of each.
class WrenchChain {
 public:
  /// One step; `function` returns the limited wrench. The chain runs the steps in the order of
  /// kSteps, and docs/architecture.md has the same list (test `limit_chain`).
  struct Step {
    const char* name;
    const char* limit;
    const char* reason;  ///< why the limit exists, or why it has this place
    Wrench (WrenchChain::*function)(const Wrench&) noexcept;
  };
  static const std::array<Step, 8> kSteps;

  const SafetyLimits set;        ///< the limits as they are set
  const SafetyLimits in_effect;  ///< the set limits, or values that fall to them
  const SafetyLimits braking;    ///< in effect, and at least what the strings exert at rest
  VibrationBudget& vibration_budget;
  GripBrake& grip_brake;
  WrenchLimits& rate_limits;
  const GripTraits& traits;
  const GripMotion& motion;
  const Wrench& acknowledged;  ///< the last wrench that the device has received
  bool fresh;                  ///< whether a wrench is wanted, and may be exerted
  double rates_s;              ///< the time for which a force rises or falls in this tick
  double passed_s;             ///< since the last tick
  // Results.
  bool brakes = false;    ///< whether the brake may have changed the wrench
  bool rejected = false;  ///< whether the wanted wrench was fresh, but not finite

  /// Passes `wanted` through all steps. Neither allocates, locks nor throws.
  Wrench apply(const Wrench& wanted) noexcept;

 private:
  Wrench finite(const Wrench& wrench) noexcept;
  Wrench total(const Wrench& wrench) noexcept;
  Wrench vibration(const Wrench& wrench) noexcept;
  Wrench brake(const Wrench& wrench) noexcept;
  Wrench rates(const Wrench& wrench) noexcept;
  Wrench effect(const Wrench& wrench) noexcept;
  Wrench brake_at_once(const Wrench& wrench) noexcept;
  Wrench damper(const Wrench& wrench) noexcept;
};

}  // namespace spidar
