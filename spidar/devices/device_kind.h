// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What is to be known of a kind of device, from which its names, lists, errors, simulation and
/// tests are made.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "spidar/boards/board.h"
#include "spidar/boards/board_parts.h"
#include "spidar/boards/usb_board.h"
#include "spidar/devices/board_info.h"
#include "spidar/emulation/emulated_transport.h"
#include "spidar/emulation/simulated_motors.h"
#include "spidar/profiles/profile.h"

namespace spidar {

struct DeviceKind : BoardKind {
  const char* board = "";  ///< "sh4", for sim:sh4; that of the real device if there is one only
  const char* names = "";  ///< how a real one may be named, separated by ", "
  /// With which it is driven if none is named: its simulation, and the real one, too, if it has no
  /// strings.
  const char* profile = kDefaultProfile;
  Verification verification = Verification::kEmulated;
  const char* note = "";  ///< what is inferred
  BoardTraits traits;     ///< of a board with strings: what profiles have to fit
  /// The emulation of the board, connected to these motors.
  std::unique_ptr<EmulatedBoard> (*emulate)(std::shared_ptr<EmulatedMotors> motors) = nullptr;
  /// The motors of the simulation, and the hand that holds them.
  std::shared_ptr<EmulatedMotors> (*simulated_motors)(
      const Profile& profile, const SimulatedMechanics& mechanics) = nullptr;

  // Not for boards on USB.

  /// Makes the real board with this whole name; `rest` is what follows its colon. Opens nothing.
  /// Throws DeviceError when `rest` is wrong.
  AnyBoard (*make)(const std::string& name, const std::string& rest,
                   const Profile& profile) = nullptr;
  /// What is plugged in, as far as the system tells: the name, and what the kind does not say.
  std::vector<BoardInfo> (*list)() = nullptr;

  /// Whether the name has to state which one is meant.
  bool needs_rest() const { return std::string(names).rfind(std::string(device) + ":", 0) == 0; }
};

// Each is in the file of its name; devices() lists them.

DeviceKind sh4_kind();
DeviceKind simple_kind();
DeviceKind uart_kind();
DeviceKind mouse_kind();
DeviceKind force_feedback_kind();
DeviceKind inverse3_kind();
DeviceKind falcon_kind();
DeviceKind sound_kind();

}  // namespace spidar
