// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The device on which a command works.
#pragma once

#include <memory>
#include <string>

#include "spidar/boards/board_settings.h"
#include "spidar/device.h"
#include "spidar/grip/grip.h"
#include "spidar/profiles/profile.h"
#include "spidar/session/board_list.h"
#include "spidar/tools/command_line.h"

namespace spidar {

/// What a command does with the motors.
enum class Motors {
  kOff,     ///< they stay at zero, so no profile is needed
  kPulled,  ///< a real board needs a profile that somebody named
};

struct ChosenDevice {
  BoardInfo board;
  /// Without a name if nobody has named one: then it only says how many strings can be read, and
  /// allows no tension.
  Profile profile;
  // One of these, not open yet.
  std::unique_ptr<Device> device;  ///< that has strings
  std::unique_ptr<Grip> grip;      ///< that has none

  const std::string& name() const noexcept { return device ? device->name() : grip->name(); }
};

/// Throws ProfileError, DeviceError, and NoProfile, which is one.
ChosenDevice choose_device(const DeviceOptions& options, Motors motors,
                           CountZero count_zero = CountZero::kByProfile);

/// Throws DeviceError when the board has no strings; its message says that `command` needs them.
void require_strings(const BoardInfo& board, const std::string& command);

/// Whether the device can output negative volts. Boards that output positive volts only refuse such
/// a profile.
bool can_reverse(const std::string& device, Profile profile);

}  // namespace spidar
