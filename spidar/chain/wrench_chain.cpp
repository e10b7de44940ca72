// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/chain/wrench_chain.h"

namespace spidar {

const std::array<WrenchChain::Step, 8> WrenchChain::kSteps{{
    {"Finite", "a wrench with a part that is not a number counts as none",
     "because no later step could compare with it", &WrenchChain::finite},
    {"Total", "force and torque as they are set",
     "so that the next two steps take a fraction of what may be given", &WrenchChain::total},
    {"Vibration", "the daily action value of Directive 2002/44/EC",
     "so that a force becomes weaker when it has shaken the hand for long",
     &WrenchChain::vibration},
    {"Brake",
     "no force outwards from where the grip has been, and no wrench for a second after it was fast",
     "because nobody may hold the grip", &WrenchChain::brake},
    {"Rates", "300 N/s and 10 N m/s unless others are set, and a ramp of 40 ms to rest and back",
     "so that a hand has the time to withstand", &WrenchChain::rates},
    {"In effect", "the limits that are set, or that fall to these at the rates",
     "because the wrench of before may be above them", &WrenchChain::effect},
    {"Brake at once",
     "the faster the grip is, the less torque, and the less force except against its motion",
     "because a force that fell at the rates would throw it", &WrenchChain::brake_at_once},
    {"Damper", "with it, the limits in effect, or what the strings exert at rest",
     "because it takes back what these have given", &WrenchChain::damper},
}};

Wrench WrenchChain::apply(const Wrench& wanted) noexcept {
  Wrench left = wanted;
  for (const Step& step : kSteps) left = (this->*step.function)(left);
  return left;
}

Wrench WrenchChain::finite(const Wrench& wrench) noexcept {
  if (wrench.is_finite()) return wrench;
  rejected = fresh;
  return {};
}

Wrench WrenchChain::total(const Wrench& wrench) noexcept {
  return limit_total(wrench, set);
}

Wrench WrenchChain::vibration(const Wrench& wrench) noexcept {
  return vibration_budget.fraction() * wrench;
}

Wrench WrenchChain::brake(const Wrench& wrench) noexcept {
  if (!traits.can_fly) return wrench;
  const Wrench left = grip_brake.apply(wrench, motion, passed_s);
  brakes = grip_brake.acts();
  return left;
}

/// Where the brake can no longer act, a force does not return at once to what it has left out.
Wrench WrenchChain::rates(const Wrench& wrench) noexcept {
  if (traits.can_fly && (!fresh || !motion.is_known())) rate_limits.shorten_to(acknowledged);
  return rate_limits.apply(wrench.is_finite() ? wrench : Wrench{}, fresh, rates_s, set);
}

/// The result of rates() falls like these limits, except for rounding and late ticks.
Wrench WrenchChain::effect(const Wrench& wrench) noexcept {
  return limit_total(wrench, in_effect);
}

Wrench WrenchChain::brake_at_once(const Wrench& wrench) noexcept {
  return brakes ? grip_brake.limit(wrench) : wrench;
}

Wrench WrenchChain::damper(const Wrench& wrench) noexcept {
  return brakes ? limit_total(wrench + grip_brake.damper(), braking) : wrench;
}

}  // namespace spidar
