// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Lists force-feedback devices.
#pragma once

#include <string>
#include <vector>

namespace spidar {

struct EvdevInfo {
  std::string path;         ///< "/dev/input/event5"
  std::string name;         ///< from the driver; may be empty
  std::string serial;       ///< empty if it has none
  std::string id;           ///< vendor and product: "046d:c24f"
  bool constant = false;    ///< supports directional force; otherwise it only rumbles
  bool accessible = false;  ///< this process may open it
};

/// Returns input devices with FF_CONSTANT, then those with only FF_RUMBLE, sorted by number. Reads
/// the kernel's description in /sys/class/input; opens no device.
std::vector<EvdevInfo> list_force_feedback();

/// Returns the name of the kernel driver of an input device ("/dev/input/event5", or a link to it):
/// "logitech", "iforce", "hid-generic", …; empty when sysfs does not name one.
std::string evdev_driver(const std::string& path);

}  // namespace spidar
