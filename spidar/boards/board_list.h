// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Lists devices without opening any.
#pragma once

#include <string>
#include <vector>

#include "core/api.h"

namespace spidar {

/// How far a driver has been tried.
enum class Trial {
  kHardware,  ///< on the real board
  kEmulated,  ///< on an emulated one that follows the published description
  kInferred,  ///< parts of it are guesses that an emulation cannot confirm
};

/// "tried on hardware", "emulated", "inferred".
SPIDAR_API const char* to_string(Trial trial) noexcept;

/// One that make_device() takes.
struct BoardInfo {
  std::string device;  ///< for make_device(): "usb:1-2", "sim"
  std::string name;    ///< "CyVerse USB 2.0 SH4"
  std::string path;    ///< on the bus: "1-2"; empty for the simulated ones
  std::string serial;  ///< empty when it has none
  std::string usb_id;  ///< "0cec:0205"; empty when not on USB
  Trial trial = Trial::kEmulated;
  std::string note;        ///< what is inferred, or why it cannot be used; may be empty
  bool accessible = true;  ///< this process may open it
  /// The default profile: of a device that this board can drive.
  std::string profile;
  bool has_strings = true;  ///< else it takes a force, and has no encoders
};

/// The devices that are plugged in, then the simulated ones. Opens and sends nothing. Serial lines
/// do not say what is behind them: listed are those that a udev rule calls /dev/spidar…. Input
/// devices are listed when they have force feedback. A machine
/// without USB has none.
SPIDAR_API std::vector<BoardInfo> list_boards();

/// The default profile for a device name: of a device that the board can drive; the general
/// default profile for an unknown name. Looks at no bus.
SPIDAR_API std::string default_profile(const std::string& device);

/// What is known of a device by what it is called, which need not be plugged in; nothing is opened.
/// Empty name: make_device() does not know it either.
SPIDAR_API BoardInfo board_info(const std::string& device);

}  // namespace spidar
