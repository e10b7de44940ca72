// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The constants of GripBrake. Each comes from physics or a simulation: the random or the searched
/// films of test_released_films.cpp, or the hands of test_released_grip.cpp. "0.59: 1.006 m/s"
/// means that with the value 0.59, the fastest released grip in the simulation moves at 1.006 m/s.
#pragma once

#include "spidar/limits/released_grip.h"

namespace spidar::brake {

// --- A grip, a hand
constexpr double kUnheldGrip_kg = 0.1;          // recognised masses: from a third to 1.2 times this
constexpr double kFirmHand_N_m = 200;           // a firm hand has 300 or more, a light one 100
constexpr double kLooseHand_N_m = 100;          // a softer hold is a loose hand or none
constexpr double kFastest_m_s = kReleased_m_s;  // a film moves a hand at 0.45 at most
constexpr double kFastest_rad_s = 20;  // a hand turns by ±45° at 4 Hz; an unheld grip reaches 40
constexpr double kFarTurn_rad = 1.75;  // a forearm turns by 90°; GripWatch's 2.1 comes 20 ms later
constexpr double kTellingForce_N = 0.1;  // a hand's own motion hides a weaker force
constexpr double kMinYield_m = 0.01;     // a hand moves this far without any force

// --- Fading and damping
constexpr double kFadeFrom_m_s = 0.58;   // 0.57: a hand of 300 N/m notices it; 0.59: 1.006 m/s
constexpr double kFadeTo_m_s = 1.0;      // no force along the motion above: 100 g have kReleased_J
constexpr double kNoRise_m_s = 0.55;     // 0.5: a hand of 300 N/m notices it
constexpr double kHeavyFrom_m_s = 0.45;  // no film of 3 N moves a hand of 300 N/m faster
constexpr double kHeavyTo_m_s = 0.57;    // at 0.577, 300 g have kReleased_J
constexpr double kLightWork_J = 0.012;   // 0.008: a hand of 300 N/m notices it, at 2 Hz
constexpr double kHeavyWork_J = 0.026;   // half of kReleased_J, for lags and the return
constexpr double kLightSwing_J = 0.016;  // stored in a hand of 300 N/m that 3 N push: 15 mJ, …
constexpr double kHeavySwing_J = 0.03;   // … and that throw 300 g: with the reversed film, 70 mJ
constexpr double kSpeedError_m_s = 0.1;  // from lag and noise; 0.2: a hand of 300 N/m notices it
constexpr double kDamping_1_s = 150;     // damping / mass: stable up to π/2 / delay, 157 for 10 ms
constexpr double kEarlier_m_s = 0.3;     // for a grip that has stored energy; 0: 1.09 m/s
constexpr double kLoop_s = 1.5e-3;       // from a pose to its force: a tick and half a tick of hold

// --- From the whole wrench to none, and back
constexpr double kRelease_s = 0.01;  // the time for 3 N at the slew limit, 300 N/s
constexpr double kRest_s = 1.0;      // a released grip stops swinging, see ItsForceRestsAndReturns
constexpr double kReturn_s = 1.0;    // slow enough that an unheld grip shows itself
constexpr double kEases_s = 0.1;     // kRelease_s: the strings throw a grip that they balance

// --- A grip that moves as the strings alone would move it
constexpr double kMemory_s = 0.05;           // a hand of 100 N/m takes 30 ms to stop a grip
constexpr double kSlowest_m_s = 0.55;        // no film moves a hand of 300 N/m this fast, …
constexpr double kSlowestAtRest_m_s = 0.15;  // … and none at all while there is no force
constexpr double kAligned = 0.8;             // cosine of the angle between both velocities, 37°
constexpr double kMinFraction = 0.85;  // seen / computed speed: a grip that is a fifth heavier
constexpr double kMaxFraction = 3;     // a grip that is a third as heavy
constexpr double kSpins_s = 0.01;      // 0.015: 1.10 m/s; wrong poses turn for 5 ms, seldom 15

// --- A grip that yields, or stores energy
constexpr double kYieldTime_s = 0.05;  // a grip in a loose hand follows a force in this time
constexpr double kFirmForce_N = 0.3;   // with kFirmHand_N_m, proves a hand after kWithstands_s
constexpr double kProbes_N = 0.5;      // > kFirmForce_N, so that a hand far out can prove itself
constexpr double kWithstands_s = 0.3;  // an unheld grip follows a force within 0.07
constexpr double kThrown_m = 0.025;    // 0.03: 1.07 m/s; 0.02: firm hands lose 3 times as much
constexpr double kThrown_m_s = 0.4;    // along the force; a film moves a hand at 0.45 at most
constexpr double kStored_s = 0.2;      // until the smoothed force has reversed and the grip is back
constexpr double kFarOut = 0.5;     // of kReleased_J stored; without: 342 mJ at 10.2 N and 58 N/m
constexpr double kThrows_J = 0.05;  // twice what throws an unheld grip of 50 g at 1 m/s

}  // namespace spidar::brake
