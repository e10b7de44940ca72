// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The constants of GripBrake. Each comes from physics, from the searches of `spidar-bench
/// released`, or from the hands of test_released_grip.cpp. "0.57: a hand of 300 N/m notices it"
/// means that with the value 0.57, such a hand would notice the brake.
#pragma once

#include <cmath>

#include "spidar/grip/grip_motion.h"
#include "spidar/limits/released_grip.h"

namespace spidar::brake {

// --- Speed
constexpr double kLoop_s = 1.5e-3;       // from a pose to its force: a tick and half a tick of hold
constexpr double kSpeedError_m_s = 0.1;  // of the extrapolated speed: test LateTicks
constexpr double kFadeFrom_m_s = 0.58;   // 0.57: a hand of 300 N/m notices it
constexpr double kFadeTo_m_s = 1.0;      // only a force that brakes above: 100 g have kReleased_J
constexpr double kDamping_N_s_m = 3.8;   // 4.5: a grip of 20 g is shaken for ever, see ComesToRest
constexpr double kAimed_rad = 0.5;       // after this rotation, a wrench still acts with cos = 0.88

// --- Energy
constexpr double kHeavyFrom_m_s = 0.47;  // 0.45: a hand of 300 N/m notices it after kHeavyWork_J
constexpr double kHeavyTo_m_s = 0.5;     // 0.52: a film of 10 N gives 300 g more than 67 mJ
constexpr double kHeavyWork_J = 0.022;   // 0.02: a hand of 300 N/m notices it

// --- Place
constexpr double kNear_m = 0.03;  // 3 N push a light hand of 100 N/m this far; 0.025: a hand that
                                  // swings at 0.3 m/s loses three times as much
constexpr double kFar_m = 0.04;   // no force outwards: a loose hand of 60 N/m stores kReleased_J
constexpr double kFollows_s = 3;  // a loose hand returns sooner; its place must not follow it

// --- Rest
constexpr double kFast_s = 0.07;   // 0.05: the force of a hand of 300 N/m rests, at 10.2 N
constexpr double kRest_s = 1.0;    // a released grip stops swinging, see ItsForceRestsAndReturns
constexpr double kReturn_s = 1.0;  // slow enough that an unheld grip goes to rest again

/// The damping of rotations, N m s/rad, for an eleventh of the smallest inertia, if the device
/// answers in one tick of three: v[k + 1] = v[k] − c T v[k − d] is stable up to c T = 2 sin(π / (4
/// d + 2)), where d intervals T are the delay of the loop and of the filter of the speed.
/// A grip of 20 g with a quarter of the inertia needs 6.8, and more because the acceleration with
/// which the speed is extrapolated is later than the speed. With 9, a grip turned to and fro for
/// ever; with 14, one turned on for more than a second (as in ComesToRest, with other pushes).
inline double turn_damping(const GripBody& body) {
  constexpr double kInertiaMargin = 11, kInterval_s = 3e-3;
  const double late = (1e3 * kLoop_s * kInterval_s + GripMotion::kLag_s) / kInterval_s;
  const double stable_1_s = 2 / kInterval_s * std::sin(M_PI / (4 * late + 2));
  return stable_1_s / kInertiaMargin * body.least_kg_m2;
}

}  // namespace spidar::brake
