// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Whether a joystick or wheel moves in the direction of the force that its driver is given.
#pragma once

#include <array>

#include "spidar/grip/grip.h"
#include "spidar/wiring/string_hold.h"

namespace spidar {

struct StickTest {
  /// Less is no answer: a hand holds it, the force does not overcome friction, or it has no motor.
  static constexpr double kLeast_m = 0.5e-3;

  /// How far it moved along the force, as a grip, in metres: right, up. A positive axis is right; a
  /// negative one answers against the force.
  std::array<double, 2> moved_m{};
  bool complete = false;  ///< false: ended early by the pace
};

/// Pushes four times along each axis that the device has, with half of the force that the gain
/// allows, for 0.2 s: to one side, twice to the other, and back, so that a drift cancels. Throws
/// DeviceError when the device is lost.
StickTest test_stick(Grip& grip, const Pace& pace);

}  // namespace spidar
