// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "tests/support/touch_surfaces.h"
#include "tests/support/touched_grip.h"

namespace spidar::test {

/// Holds the grip so loosely that it bounces after a tap.
constexpr Hand kLooseHand{"loose", 30, 0.5};

/// Simulates a hand that taps a plane: from 20 mm above to `depth_m` below it and out again, at the
/// same speed. Returns the largest energy that a contact gave out (below 0: absorbed), J; −∞ if the
/// grip never touched.
inline double tap_J(const touch::ContactSettings& settings, const Hand& hand, double speed_m_s,
                    double depth_m) {
  constexpr double kAbove_m = 0.02;
  constexpr int kFaded = 20;  // in ticks: ten times the drive's lag
  static const touch::HeightField plane = plane_field(0);
  TouchedGrip grip(hand, {0, 0, kAbove_m});
  touch::ContactForce force;
  const int down = static_cast<int>((kAbove_m + depth_m) / speed_m_s / TouchedGrip::kTick_s);
  double most_J = -std::numeric_limits<double>::infinity();
  double begin_J = 0;
  bool in_contact = false;
  int ticks_away = 0;
  for (int n = 0; n < 2 * down + 400; ++n) {
    const Eigen::Vector3d wanted_N =
        force.tick({&plane}, nullptr, settings, grip.measured_m(), TouchedGrip::kTick_s);
    if (force.proxy().touching()) {
      if (!in_contact) begin_J = grip.given_J();
      in_contact = true;
      ticks_away = 0;
    } else if (in_contact && ++ticks_away == kFaded) {
      in_contact = false;
      most_J = std::max(most_J, begin_J - grip.given_J());
    }
    const double hand_m = -depth_m + speed_m_s * TouchedGrip::kTick_s * std::abs(n - down);
    grip.exchange(wanted_N, {0, 0, std::min(hand_m, kAbove_m)});
  }
  return most_J;
}

/// The largest value over taps of all speeds up to 1 m/s and of several depths.
inline double worst_tap_J(const touch::ContactSettings& settings, const Hand& hand) {
  double most_J = -std::numeric_limits<double>::infinity();
  for (double speed_m_s = 0.02; speed_m_s < 1; speed_m_s += 0.02) {
    for (const double depth_m : {0.001, 0.002, 0.004, 0.006, 0.010}) {
      most_J = std::max(most_J, tap_J(settings, hand, speed_m_s, depth_m));
    }
  }
  return most_J;
}

}  // namespace spidar::test
