// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Tests whether a device that takes a force moves in the direction of that force, and whether a
/// spring pulls it back.
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

  /// The motion of the grip along the force: right, up, towards the viewer. Positive values are
  /// correct; where a value is negative, the stick moved against the force.
  std::array<double, 3> moved_m{};
  /// The force of a spring that pulls the stick back, at the place to which the push moves it, as a
  /// fraction of the push. 0: none was found. Friction of the stick makes the spring look weaker.
  std::array<double, 3> spring{};
  /// The weakest spring that would have been found, because it moves the stick back by kMin_m.
  std::array<double, 3> least_spring{};
  std::string description;  ///< description of the open device
  bool complete = false;    ///< false if the pace ended the test early
};

/// Pushes four times along each axis that the device has, for 0.2 s: to one side, twice to the
/// other, and back, so that a drift cancels. Releases the stick for 0.3 s after each push. A push
/// is repeated when this program was stopped. Throws DeviceError when the device is lost, or does
/// not know its position.
StickTest test_stick(Grip& grip, const Pace& pace, double push_N);

/// `can` is what the device can do; `reach_m` is the position of the grip when the stick is pushed
/// all the way; `device` is the name that was tested: "ff" or "ff:PATH,flip=x".
std::string stick_report(const StickTest& test, const GripAbilities& can,
                         const Eigen::Vector2d& reach_m, const std::string& device);

}  // namespace spidar::selftest
