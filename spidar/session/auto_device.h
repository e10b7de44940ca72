// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What the device "auto" may be.
#pragma once

#include <string>
#include <vector>

namespace spidar {

constexpr const char* kAutoDevice = "auto";

struct AutoDevice {
  std::string device;   ///< for make_grip()
  std::string why;      ///< what it is: "a gamepad that rumbles"
  std::string why_not;  ///< why it must not be used, and what would be right; empty: it may be
};

/// What is plugged in and gives a force, in the order in which it is to be tried: a SPIDAR whose
/// profile somebody has confirmed, a joystick or wheel with directional force, an Inverse3, a
/// Falcon, and what rumbles. Boards whose profile nobody has named come after the others with
/// strings, with `why_not`, and so does what is used only if it is named. Opens nothing, so that
/// what is listed may still be in use, or not be permitted.
std::vector<AutoDevice> auto_devices();

}  // namespace spidar
