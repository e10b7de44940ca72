// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <string>

namespace spidar {

/// A device that make_grip() can open, and what is known about it before that.
struct DeviceInfo {
  std::string device;                 ///< for make_grip(): "usb:1-2", "sim"
  std::string name;                   ///< "CyVerse USB 2.0 SH4"
  std::string path;                   ///< on the bus: "1-2"; empty for simulated devices
  std::string serial;                 ///< empty when the device has none
  std::string usb_id;                 ///< "0cec:0205"; empty when not on USB
  const char* evidence = "emulated";  ///< DeviceKind::evidence
  std::string note;        ///< what is inferred, or why the device cannot be used; may be empty
  bool accessible = true;  ///< this process may open the device
  /// The profile that drives the device if the user names none: that of a simulation, that of a
  /// device without strings, or the one that was confirmed for this board. Empty: none, so the
  /// motors of the board get no force until the user names a profile (see profile_choice.h).
  std::string profile;
  std::string memory_error;  ///< why confirmed profiles cannot be read; may be empty
  /// Profile::board of fitting profiles: "usb-sh4"; empty if unknown or without strings.
  std::string profile_board;
  bool has_strings = true;  ///< otherwise the device takes a force, and has no encoders
  bool directional = true;  ///< otherwise the device renders only the strength of the force
};

/// DeviceInfo::note of a device that 70-spidar.rules would make accessible.
constexpr const char* kNoUdevRule = "no permission: udev rule 70-spidar.rules";

}  // namespace spidar
