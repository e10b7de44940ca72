// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The USB devices that have a driver, one row for each.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "spidar/boards/board.h"
#include "spidar/boards/force_board.h"
#include "spidar/boards/trial.h"
#include "spidar/profiles/profile.h"
#include "spidar/transports/usb_transport.h"

namespace spidar {

enum class UsbFamily {
  kCyverse,  ///< "usb": SH4 or Simple
  kMouse,    ///< "mouse": SPIDAR-mouse, whose USB id other devices also use
  kFalcon,   ///< "falcon": Novint Falcon
};

struct UsbBoardKind {
  UsbFamily family;
  uint16_t vendor;
  uint16_t product;
  const char* name;           ///< "CyVerse USB 2.0 SH4"
  const char* profile_board;  ///< Profile::board of profiles for it; empty for one without strings
  Trial trial;
  const char* note;  ///< what is inferred
  UsbPipes pipes;
  /// Throws DeviceError when the board cannot drive the profile. Null for one without strings.
  std::unique_ptr<Board> (*make)(const std::string& name, const Profile& profile,
                                 std::unique_ptr<Transport> transport);

  /// Null for one with strings.
  std::unique_ptr<ForceBoard> (*make_force)(const std::string& name,
                                            std::unique_ptr<Transport> transport);

  /// "0cec:0205"
  std::string id() const;
};

const std::vector<UsbBoardKind>& usb_kinds();

/// "usb", "mouse" or "falcon", for make_grip().
const char* device_of(UsbFamily family) noexcept;

}  // namespace spidar
