// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The kinds of devices that have a driver, and which of them a name means.
#pragma once

#include <string>
#include <vector>

#include "spidar/devices/sim/simulated_motors.h"
#include "spidar/link/board.h"
#include "spidar/link/device_kind.h"
#include "spidar/profiles/profile.h"

namespace spidar {

/// All kinds, in the order in which they are listed and device=auto tries them: those with strings,
/// then the others.
const std::vector<DeviceKind>& devices();
/// Those on USB.
std::vector<DeviceKind> usb_kinds();

/// A device's name, split at its first colon.
struct DeviceName {
  explicit DeviceName(const std::string& text);

  std::string device;
  std::string rest;
  bool has_end = true;  ///< there is something after the colon, if there is one
};

/// The kinds that `device`, the part of a name before the colon, may mean.
std::vector<const DeviceKind*> kinds_called(const std::string& device);

/// The kind that a name like "sim:sh4" simulates. Null if there is no such board, and for "sim".
const DeviceKind* simulated_kind(const DeviceName& name);

/// The driver of a board with its emulation behind it, which needs no thread and no guardian.
/// Throws DeviceError when the board cannot drive the profile, and std::invalid_argument as
/// SimulatedDevice does.
boards::AnyBoard simulated_board(const DeviceKind& kind, const std::string& name,
                                 const Profile& profile,
                                 const emulated::SimulatedMechanics& mechanics = {});

}  // namespace spidar
