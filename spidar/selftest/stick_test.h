// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Whether a device that takes a force moves in the direction of that force, and whether a spring
/// pulls it back.
#pragma once

#include <array>
#include <string>

#include <Eigen/Core>

#include "spidar/grip/grip.h"
#include "spidar/selftest/hold.h"

namespace spidar::selftest {

struct StickTest {
  /// A smaller motion is no answer: a hand holds the stick, the force does not overcome friction,
  /// or there is no motor.
  static constexpr double kMin_m = 0.5e-3;

  /// How far it moved along the force, as a grip, in metres: right, up, towards the viewer.
  /// Positive values are correct; on an axis with a negative one, it moved against the force.
  std::array<double, 3> moved_m{};
  /// Force of a spring that pulls it back, at the place to which the push moves it from its middle,
  /// as a fraction of the push. 0: none was found. Friction of the stick makes it look weaker.
  std::array<double, 3> spring{};
  /// The weakest spring that would have been found, because it moves the stick back by kMin_m.
  std::array<double, 3> least_spring{};
  std::string description;  ///< of the open device
  bool complete = false;    ///< false: ended early by the pace
};

/// Pushes four times along each axis that the device has, for 0.2 s: to one side, twice to the
/// other, and back, so that a drift cancels. Lets it go for 0.3 s after each. A push is repeated
/// when this program stood still. Throws DeviceError when the device is lost, or does not know
/// where it is.
StickTest test_stick(Grip& grip, const Pace& pace, double push_N);

/// `can`: what the device can do; `reach_m`: where the grip is when it is pushed all the way;
/// `device`: "ff" or "ff:PATH,flip=x", as it was tested.
std::string stick_report(const StickTest& test, const GripAbilities& can,
                         const Eigen::Vector2d& reach_m, const std::string& device);

}  // namespace spidar::selftest
