// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Lists devices without opening them, and chooses the one that "auto" stands for.
#pragma once

#include <string>
#include <vector>

#include "spidar/link/device_info.h"

namespace spidar {

/// Returns the devices that are plugged in, then the simulated ones. Opens and sends nothing. A
/// serial line does not identify the board behind it, so only lines that a udev rule names
/// /dev/spidar… are listed. An Inverse3 is listed while its service runs. Input devices are listed
/// if they have force feedback. A machine without USB has no USB devices.
std::vector<DeviceInfo> list_boards();

/// Returns the profile that the name of a device alone determines, which the device can drive, and
/// the general default profile for an unknown name. Empty for a real board with strings. Does not
/// access a bus.
std::string default_profile(const std::string& device);

/// Returns what is known about a device from its name. The device need not be plugged in, and
/// nothing is opened. If make_grip() does not know the device, the name in the result is empty.
DeviceInfo board_info(const std::string& device);

/// The device name that stands for the first usable one of auto_devices().
constexpr const char* kAutoDevice = "auto";

struct AutoDevice {
  std::string device;   ///< for make_grip()
  std::string why;      ///< what it is: "a gamepad that rumbles"
  std::string why_not;  ///< why it must not be used, and what would be right; empty: it may be
};

/// The devices that are plugged in and could give a force, in the order in which they are to be
/// tried: a SPIDAR whose profile somebody has confirmed, the others in the order of devices(), and
/// those that only rumble. `profile` is one that is named now, or empty: then it is only for the
/// board for which it was confirmed or, if it is the only board with strings, the one that is
/// there. Boards without a confirmed profile, and those that were confirmed for another one than
/// `profile`, come after the others with strings, with `why_not`; devices on USB that are used only
/// if they are named come last, also with `why_not`. Opens nothing, so that a listed device may
/// still be in use, or not be permitted.
std::vector<AutoDevice> auto_devices(const std::string& profile = {});

/// Whether two profiles are the same, as they are named or, of a file, where it is.
bool is_same_profile(const std::string& one, const std::string& other);

}  // namespace spidar
