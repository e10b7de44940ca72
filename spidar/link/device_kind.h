// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The description of a kind of device, from which its names, lists, errors, simulation and tests
/// are made.
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
  const char* device = "";  ///< what its name for make_grip() begins with: "usb"
  const char* board = "";   ///< "sh4", for sim:sh4; `device` again where that has one board only
  const char* title = "";   ///< for people: "CyVerse USB 2.0 SH4"
  const char* names = "";   ///< how a real one may be named, separated by ", "
  UsbId usb = {};           ///< vendor 0 for one that is not on USB
  /// Profile::board of profiles for it; empty for one without strings.
  const char* profile_board = "";
  /// The profile with which its simulation is driven if none is named, and the real device, too, if
  /// it has no strings.
  const char* profile = kDefaultProfile;
  boards::Traits traits = {};  ///< of a board with strings; profiles have to fit them
  /// What device=auto calls a device without strings that it has chosen: "a Novint Falcon". Empty:
  /// such a device is used only if it is named.
  const char* chosen_as = "";
  /// How far the driver has been tested: "emulated", on a board that follows the published
  /// description, or "inferred", if parts of that are inferred, which an emulation cannot confirm.
  const char* evidence = "emulated";
  const char* note = "";  ///< what is inferred

  /// Makes the board at the other end of a transport. Throws DeviceError when it cannot drive the
  /// profile.
  boards::AnyBoard (*attach)(const std::string& name, const Profile& profile,
                             std::unique_ptr<Transport> transport) = nullptr;
  /// The emulation of the board, connected to these motors; null when there is none.
  std::unique_ptr<emulated::Board> (*emulate)(std::shared_ptr<emulated::Motors> motors) = nullptr;
  /// Without strings: the hand of the simulation; null when nothing feels what the board puts out.
  std::shared_ptr<emulated::Motors> (*hand)() = nullptr;

  // Not for boards on USB.

  /// Makes the real board with this whole name; `rest` is what follows its colon. Opens nothing.
  /// Throws DeviceError when `rest` is wrong.
  boards::AnyBoard (*make)(const std::string& name, const std::string& rest,
                           const Profile& profile) = nullptr;
  /// Lists what is plugged in, as far as the system tells: names, and what the kind does not say.
  std::vector<DeviceInfo> (*list)() = nullptr;

  bool has_strings() const noexcept { return *profile_board != '\0'; }
  /// Whether the name has to state which one is meant.
  bool needs_rest() const { return std::string(names).rfind(std::string(device) + ":", 0) == 0; }
};

// For the members of a DeviceKind:

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
