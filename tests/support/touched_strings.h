// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <functional>

#include <Eigen/Core>

#include "core/touch/contact_force.h"
#include "tests/support/touch_surfaces.h"
#include "tests/support/touched_grip.h"

namespace spidar::test {

/// Contact settings and the simultaneous force of the film.
struct StringTouch {
  touch::ContactSettings contact;
  bool texture = false;
  /// Amplitude of the film's force, which varies as in a film with a moving object.
  double film_N = 0;
  /// How much more the drives lag than the profile says.
  double more_lag_s = 0;
  double mass_kg = 0.1;  ///< of the grip
  /// Above 0: no scene, but an application's callback for a wall at z = 0 with this stiffness.
  double wall_N_m = 0;
  bool passive = true;  ///< of the callback
};

/// Target position of the hand at a time in seconds.
using HandPath = std::function<Eigen::Vector3d(double)>;

/// Measures the energy that a contact adds to the grip of the simulated device, through pose
/// solver, safety chain, tension solver, D/A steps, drives and strings. Moves the hand along
/// `path_m` in contact with a scene for `ticks` ticks of the haptic loop.
///
/// A second loop runs with the same film, clock and encoder counts, but without a surface. The work
/// of a contact is that of the difference between the tensions of the two loops on the strings of
/// the grip in contact, so it includes neither the work of the film nor that of the rest tensions.
/// A contact ends when its force has faded. A contact does not count if the grip was taken for
/// released in one loop only, because the work is then that of the film's force, which rests there.
ContactEnergy touch_through_strings(const TouchScene& scene, const StringTouch& touch,
                                    const Hand& hand, long ticks, const HandPath& path_m);

/// The same for a hand that explores at random.
ContactEnergy explore_through_strings(const TouchScene& scene, const StringTouch& touch,
                                      const Hand& hand, long ticks, unsigned seed);

}  // namespace spidar::test
