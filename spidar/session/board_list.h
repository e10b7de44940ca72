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

/// Returns the profile that follows from the name of a device alone: empty for a real board with
/// strings, and kDefaultProfile for an unknown name. Accesses no bus.
std::string default_profile(const std::string& device);

/// Returns what is known about a device from its name. The device need not be plugged in, and
/// nothing is opened. DeviceInfo::name is empty if make_grip() does not know the device.
DeviceInfo board_info(const std::string& device);

/// The device name that stands for the first usable one of auto_devices().
constexpr const char* kAutoDevice = "auto";

struct AutoDevice {
  std::string device;  ///< for make_grip()
  std::string why;     ///< what the device is: "a gamepad that rumbles"
  /// Why the device must not be used, and what would be right; empty if it may.
  std::string why_not;
};

/// Returns the devices that are plugged in and could exert a force, in the order in which
/// device=auto tries them: first a SPIDAR whose profile somebody has confirmed, then the others in
/// the order of devices(), then those that only rumble.
///
/// `profile` is the profile that the user names now, or empty. It applies only to the board for
/// which it was confirmed or, if there is just one board with strings, to that board. Boards
/// without a confirmed profile, and boards for which another profile than `profile` was confirmed,
/// come after the other boards with strings, with `why_not`. Devices on USB that are used only by
/// name come last, also with `why_not`. Opens nothing, so a listed device may be in use or
/// forbidden.
std::vector<AutoDevice> auto_devices(const std::string& profile = {});

/// Whether two profiles have the same name or are the same file.
bool is_same_profile(const std::string& one, const std::string& other);

}  // namespace spidar
