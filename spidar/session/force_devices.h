// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The devices that take a force instead of tensions, in one table.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "spidar/boards/force_board.h"
#include "spidar/boards/trial.h"
#include "spidar/profiles/profile.h"

namespace spidar {

/// What is known of a kind of device, and how it is made. `spec` is the whole name of a device, as
/// for make_grip().
struct ForceDevice {
  const char* kind;       ///< its name, up to the colon
  const char* title;      ///< for people
  const char* simulated;  ///< the same, of `sim:KIND`
  const char* names;      ///< how it may be named, separated by ", "
  Trial trial;
  /// `rest` is what follows the colon. Opens nothing. Throws DeviceError when `rest` is wrong.
  std::unique_ptr<ForceBoard> (*make)(const std::string& spec, const std::string& rest,
                                      const Profile& profile);
  /// The board behind its packets, which an emulation answers.
  std::unique_ptr<ForceBoard> (*simulate)(const std::string& spec, const Profile& profile);
};

const std::vector<ForceDevice>& force_devices();

/// Null when no such device takes a force.
const ForceDevice* force_device(const std::string& kind);

}  // namespace spidar
