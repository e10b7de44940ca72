// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What the device "auto" may be.
#pragma once

#include <string>
#include <vector>

namespace spidar {

constexpr const char* kAutoDevice = "auto";

struct AutoDevice {
  std::string device;  ///< for make_grip()
  std::string why;     ///< what it is: "a gamepad that rumbles"
};

/// What is plugged in and gives a force, in the order in which it is to be tried: a SPIDAR whose
/// profile somebody has confirmed, a joystick or wheel with directional force, an Inverse3, a
/// Falcon, and what rumbles. Never a board whose profile nobody has named. Opens nothing, so that
/// what is listed may still be in use, or not be permitted.
std::vector<AutoDevice> auto_devices();

}  // namespace spidar
