// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The table of the devices that have a driver: a row each, from which all else is made.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "spidar/boards/board.h"
#include "spidar/boards/usb_board.h"
#include "spidar/emulation/emulated_transport.h"
#include "spidar/emulation/simulated_motors.h"
#include "spidar/profiles/profile.h"
#include "spidar/session/board_list.h"

namespace spidar {

/// A row of devices().
struct DeviceKind : BoardKind {
  const char* board;  ///< "sh4", for sim:sh4; that of the real device if there is one board only
  const char* names;  ///< how a real one may be named, separated by ", "
  /// With which it is driven if none is named: its simulation, and the real one, too, if it has no
  /// strings.
  const char* profile;
  Verification verification;
  const char* note;  ///< what is inferred
  /// The emulation of the board, connected to these motors.
  std::unique_ptr<EmulatedBoard> (*emulate)(std::shared_ptr<EmulatedMotors> motors);
  /// The motors of the simulation, and the hand that holds them.
  std::shared_ptr<EmulatedMotors> (*simulated_motors)(const Profile& profile,
                                                      const SimulatedMechanics& mechanics);

  // Not for boards on USB.

  /// Makes the real board with this whole name; `rest` is what follows its colon. Opens nothing.
  /// Throws DeviceError when `rest` is wrong.
  AnyBoard (*make)(const std::string& name, const std::string& rest,
                   const Profile& profile) = nullptr;
  /// What is plugged in, as far as the system tells: the name, and what this row does not say.
  std::vector<BoardInfo> (*list)() = nullptr;

  /// Whether the name has to state which one is meant.
  bool needs_rest() const { return std::string(names).rfind(std::string(device) + ":", 0) == 0; }
};

const std::vector<DeviceKind>& devices();

/// A device's name, split at its first colon.
struct DeviceName {
  explicit DeviceName(const std::string& text);

  std::string device;
  std::string rest;
  bool has_end = true;  ///< there is something after the colon, if there is one
};

/// The kinds that `device`, the part of a name before the colon, may mean.
std::vector<const DeviceKind*> kinds_called(const std::string& device);

/// Of "sim:sh4". Null when there is no such board, and for "sim".
const DeviceKind* simulated_kind(const DeviceName& name);

/// The board that its emulation answers, which needs no thread and no guardian. Throws DeviceError
/// when the board cannot drive the profile, and std::invalid_argument as SimulatedDevice does.
AnyBoard simulated_board(const DeviceKind& kind, const std::string& name, const Profile& profile,
                         const SimulatedMechanics& mechanics = {});

}  // namespace spidar
