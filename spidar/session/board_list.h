// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Lists devices without opening them.
#pragma once

#include <string>
#include <vector>

#include "spidar/devices/board_info.h"

namespace spidar {

/// Returns the devices that are plugged in, then the simulated ones. Opens and sends nothing. A
/// serial line does not identify the board behind it, so only lines that a udev rule names
/// /dev/spidar… are listed. An Inverse3 is listed while its service runs. Input devices are listed
/// if they have force feedback. A machine without USB has no USB devices.
std::vector<BoardInfo> list_boards();

/// Returns the profile that the name of a device alone determines, which the device can drive, and
/// the general default profile for an unknown name. Empty for a real board with strings. Does not
/// access a bus.
std::string default_profile(const std::string& device);

/// Returns what is known about a device from its name. The device need not be plugged in, and
/// nothing is opened. If make_grip() does not know the device either, the name in the result is
/// empty.
BoardInfo board_info(const std::string& device);

}  // namespace spidar
