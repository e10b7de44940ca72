// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The energy that a contact adds to the grip of the simulated device: through pose solver, safety
/// chain, tension solver, D/A steps, drives and strings.
#pragma once

#include <functional>

#include <Eigen/Core>

#include "core/touch/contact_force.h"
#include "tests/support/touch_surfaces.h"
#include "tests/support/touched_grip.h"

namespace spidar::test {

/// What is touched, and what is felt beside it.
struct StringTouch {
  ContactSettings contact;
  bool texture = false;
  /// Amplitude of a force of the film, which varies as that of a film with a moving object does.
  double film_N = 0;
};

/// Where the hand wants to be at a time in seconds.
using HandPath = std::function<Eigen::Vector3d(double)>;

/// Lets the hand touch a scene for so many ticks of the haptic loop.
///
/// What a contact adds is counted: a second loop has the same film, the same clock and the same
/// encoder counts, but nothing to touch. The work of a contact is that of the difference between
/// the tensions of the two, on the strings of the grip that is touched. So neither the film's work
/// nor that of the tensions at rest is part of it. A contact is over when its force has faded.
ContactEnergy touch_through_strings(const TouchScene& scene, const StringTouch& touch,
                                    const Hand& hand, long ticks, const HandPath& path_m);

/// The same of a hand that explores at random.
ContactEnergy explore_through_strings(const TouchScene& scene, const StringTouch& touch,
                                      const Hand& hand, long ticks, unsigned seed);

}  // namespace spidar::test
