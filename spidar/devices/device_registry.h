// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The kinds of devices that have a driver, and which of them a name means.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "spidar/devices/sim/grip_model.h"
#include "spidar/link/board.h"
#include "spidar/link/device_kind.h"
#include "spidar/profiles/profile.h"

namespace spidar {

/// Returns all kinds, in the order in which they are listed and device=auto tries them: first those
/// with strings, then the others.
const std::vector<DeviceKind>& devices();
std::vector<DeviceKind> usb_kinds();

struct DeviceName {
  explicit DeviceName(const std::string& text);

  std::string device;
  std::string rest;
  bool has_end = true;  ///< whether something follows the colon, if there is one
};

/// Returns the kinds that `device`, the part of a name before the colon, may mean.
std::vector<const DeviceKind*> kinds_called(const std::string& device);

/// Returns the kind that a name like "sim:sh4" simulates; null for other names, and for "sim".
const DeviceKind* simulated_kind(const DeviceName& name);

/// The mechanics that a simulated board drives.
struct SimulatedMechanics {
  std::optional<GripModel> model;  ///< none: that of the profile
  std::function<int64_t()> clock;  ///< none: CLOCK_MONOTONIC
};

/// Returns the driver of a board with its emulation behind it, which needs neither a thread nor a
/// guardian. Throws DeviceError when the board cannot drive the profile, and std::invalid_argument
/// as SimulatedDevice does.
boards::AnyBoard simulated_board(const DeviceKind& kind, const std::string& name,
                                 const Profile& profile, const SimulatedMechanics& mechanics = {});

}  // namespace spidar
