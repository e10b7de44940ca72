// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/chain/tension_chain.h"

#include <algorithm>

namespace spidar {

const std::array<TensionChain::Step, 6> TensionChain::kSteps{{
    {"Strings", "each is taut, and pulls no more than the heat of its motor allows",
     "and of such tensions those are found that give the wrench best", &TensionChain::strings},
    {"Delivered", "force and torque of all strings are within the limits in effect",
     "because least squares may overshoot, and the strings at rest pull, too",
     &TensionChain::delivered},
    {"Push", "no more power than the wrench of the brake has",
     "because strings that cannot give it might push the grip instead", &TensionChain::push},
    {"Power", "0.2 s from none to all after opening, and 50 ms back before closing",
     "so that no string is jerked", &TensionChain::power},
    {"Pace", "20 ms for the range of a string, or 300 N/s, except for what the brake takes",
     "because a hand would feel it when tensions move from some strings to others",
     &TensionChain::pace},
    {"Range", "from zero to the largest tension of the profile", "whatever came before",
     &TensionChain::range},
}};

StringVector TensionChain::apply(const Tick& tick) noexcept {
  StringVector left_N = profile_.min_tension_N();
  for (const Step& step : kSteps) left_N = (this->*step.function)(left_N, tick);
  return left_N;
}

void TensionChain::reset() noexcept {
  acknowledged_N_.setZero();
  command_.reset();
  slew_.reset(acknowledged_N_);
}

StringVector TensionChain::strings(const StringVector&, const Tick& tick) noexcept {
  command_.exclude(tick.left_out);
  if (tick.command.fresh) return command_.solve(tick.W, tick.command.wrench, heat_.limit_N());
  // Near the end of the ramp to zero the wrench may still be large. Solving for that wrench would
  // leave the tensions too little time to fall.
  const double power = tick.command.power;
  if (power > 0) command_.begin_fade(acknowledged_N_ / power);
  return command_.fade(tick.command.wrench, tick.trusted ? 1 : TensionCommand::kLostPace);
}

StringVector TensionChain::delivered(const StringVector& tension_N, const Tick& tick) noexcept {
  if (!tick.command.fresh) return tension_N;
  return command_.limit(tick.W, tick.command.limits, tick.pose, tick.motion);
}

/// Reduces the added tensions so that they give the grip no more power than the wrench would.
StringVector TensionChain::push(const StringVector& tension_N, const Tick& tick) noexcept {
  if (!tick.command.brakes) return tension_N;
  const GripVelocity then = tick.motion.velocity_in(profile_.drive_lag_s);
  Eigen::Matrix<double, 6, 1> motion;
  motion << then.linear_m_s, then.angular_rad_s;
  const StringVector rest_N = profile_.min_tension_N();
  const double added_W = motion.dot(tick.W * (tension_N - rest_N));
  const double most_W = std::max(0.0, motion.dot(tick.command.wrench.stacked()));
  if (!(added_W > most_W)) return tension_N;
  return rest_N + most_W / added_W * (tension_N - rest_N);
}

StringVector TensionChain::power(const StringVector& tension_N, const Tick& tick) noexcept {
  return tick.command.power * tension_N;
}

StringVector TensionChain::pace(const StringVector& tension_N, const Tick& tick) noexcept {
  if (tick.command.brakes) {
    const GripVelocity now = tick.motion.velocity_in(0);
    const Eigen::Matrix<double, 6, 1> change = tick.W * (tension_N - acknowledged_N_);
    const bool pushes =
        change.head<3>().dot(now.linear_m_s) + change.tail<3>().dot(now.angular_rad_s) > 0;
    if (!pushes) slew_.reset(tension_N);
  }
  return slew_.apply(tension_N, profile_, tick.command.dt_s);
}

StringVector TensionChain::range(const StringVector& tension_N, const Tick&) noexcept {
  return bound_tensions(tension_N, profile_);
}

}  // namespace spidar
