// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The description of a kind of device, from which the project makes its names, lists, errors,
/// simulation and tests.
#pragma once

#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "spidar/link/board.h"
#include "spidar/link/board_parts.h"
#include "spidar/link/device_info.h"
#include "spidar/link/emulated_transport.h"
#include "spidar/profiles/profile.h"
#include "spidar/transports/usb_transport.h"

namespace spidar {

struct DeviceKind {
  const char* device = "";  ///< the beginning of its names for make_grip(): "usb"
  /// "sh4", for sim:sh4; the same as `device` where that has one board only.
  const char* board = "";
  const char* title = "";  ///< for people: "CyVerse USB 2.0 SH4"
  const char* names = "";  ///< the possible names of a real device, separated by ", "
  UsbId usb = {};          ///< vendor 0 for a device that is not on USB
  /// Profile::board of fitting profiles; empty for a device without strings.
  const char* profile_board = "";
  /// The profile for the simulation if the user names none; without strings, for the real device,
  /// too.
  const char* profile = kDefaultProfile;
  boards::Traits traits = {};  ///< of a board with strings; profiles must fit them
  /// What messages call a device without strings that device=auto has chosen: "a Novint Falcon".
  /// Empty: device=auto does not choose such a device.
  const char* chosen_as = "";
  /// How far the driver has been tested: "emulated", on an emulation of the published description,
  /// or "inferred", if parts of that description are inferred, which an emulation cannot confirm.
  const char* evidence = "emulated";
  const char* note = "";  ///< what is inferred

  /// Makes the board at the other end of a transport. Throws DeviceError when the board cannot
  /// drive the profile.
  boards::AnyBoard (*attach)(const std::string& name, const Profile& profile,
                             std::unique_ptr<Transport> transport) = nullptr;
  /// Makes the emulation of the board, connected to these motors; null when there is none.
  std::unique_ptr<emulated::Board> (*emulate)(std::shared_ptr<emulated::Motors> motors) = nullptr;
  /// Without strings: the simulated hand; null when the simulation has none.
  std::shared_ptr<emulated::Motors> (*hand)() = nullptr;

  // The functions below are only for devices that are not on USB.

  /// Makes the real board with this whole name; `rest` is the part after the colon. Opens nothing.
  /// Throws DeviceError when `rest` is wrong.
  boards::AnyBoard (*make)(const std::string& name, const std::string& rest,
                           const Profile& profile) = nullptr;
  /// Lists the devices that are plugged in, as far as the system tells: names, and what the kind
  /// does not determine.
  std::vector<DeviceInfo> (*list)() = nullptr;

  bool has_strings() const noexcept { return *profile_board != '\0'; }
  /// Whether the name must state which device is meant.
  bool needs_rest() const { return std::string(names).rfind(std::string(device) + ":", 0) == 0; }
};

// Functions for the members `attach` and `emulate` of a DeviceKind.

template <typename BoardType>
boards::AnyBoard attach(const std::string& name, const Profile& profile,
                        std::unique_ptr<Transport> transport) {
  if constexpr (std::is_base_of_v<boards::Board, BoardType>) {
    return std::make_unique<BoardType>(name, profile, std::move(transport));
  } else {
    return std::make_unique<BoardType>(name, std::move(transport));
  }
}

template <typename Emulated>
std::unique_ptr<emulated::Board> emulate(std::shared_ptr<emulated::Motors> motors) {
  return std::make_unique<Emulated>(std::move(motors));
}

}  // namespace spidar
