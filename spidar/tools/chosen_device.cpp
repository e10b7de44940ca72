// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/tools/chosen_device.h"

#include "spidar/session/device_factory.h"

namespace spidar {
namespace {

bool can_drive(const std::string& device, const Profile& profile) {
  try {
    make_device(device, profile);
    return true;
  } catch (const DeviceError&) {
    return false;
  }
}

}  // namespace

ChosenDevice choose_device(const DeviceOptions& options, CountZero count_zero) {
  ChosenDevice chosen;
  chosen.board = board_info(options.device);
  chosen.profile = load_profile(options.profile.empty() ? chosen.board.profile : options.profile);
  BoardSettings settings;
  settings.count_zero = count_zero;
  // No tool is in such a hurry that it could not wait for an exchange.
  settings.threaded = false;
  if (chosen.board.has_strings)
    chosen.device = make_device(options.device, chosen.profile, settings);
  else
    chosen.grip = make_grip(options.device, chosen.profile, settings);
  return chosen;
}

void require_strings(const BoardInfo& board, const std::string& command) {
  if (!board.has_strings)
    throw DeviceError(board.device + ": " + command +
                      " is for devices with strings and encoders; this device has neither");
}

bool can_reverse(const std::string& device, Profile profile) {
  profile.drives[0].motor_sign = -1;
  return can_drive(device, profile);
}

}  // namespace spidar
