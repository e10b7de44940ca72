// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// How strongly the rotation of a grip may be damped.
#pragma once

#include <cmath>

#include "spidar/grip/grip_motion.h"
#include "spidar/limits/released_turn.h"
#include "spidar/loop/brake_table.h"

namespace spidar::brake {

/// The largest damping / inertia with which a damper is stable, 1/s, if the device answers once in
/// `interval_s`. The damped speed is extrapolated over the lag of the drives. The remaining delay
/// is that of the loop and of the filter of the speed, d intervals T, and v[k + 1] = v[k] − c T v[k
/// − d] is stable up to c T = 2 sin(π / (4 d + 2)).
inline double stable_damping_1_s(double interval_s) {
  const double late = (1e3 * kLoop_s * interval_s + GripMotion::kLag_s) / interval_s;
  return 2 / interval_s * std::sin(M_PI / (4 * late + 2));
}

/// The damping of rotations, N m s/rad: stable for a fifth of the smallest inertia, if the device
/// answers in one tick of three.
inline double turn_damping(const GripBody& body) {
  constexpr double kInertiaMargin = 5, kSlowest_s = 3e-3;
  return stable_damping_1_s(kSlowest_s) / kInertiaMargin * body.least_kg_m2;
}

}  // namespace spidar::brake
