// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/tools/chosen_device.h"

#include "spidar/session/device_factory.h"
#include "spidar/session/profile_choice.h"

namespace spidar {
namespace {

/// One with which the board can be read, and no motor can be pulled.
Profile to_read_only(const BoardInfo& board) {
  const std::vector<std::string> fitting = fitting_profiles(board);
  if (fitting.empty()) throw NoProfile(board);
  Profile profile = load_profile(fitting.front());
  profile.name.clear();
  for (StringDrive& drive : profile.drives) drive.min_tension_N = drive.max_tension_N = 0;
  return profile;
}

}  // namespace

ChosenDevice choose_device(const DeviceOptions& options, Motors motors, CountZero count_zero) {
  ChosenDevice chosen;
  chosen.board = board_info(options.device);
  const bool named = !options.profile.empty() || !chosen.board.profile.empty();
  if (named || motors == Motors::kPulled)
    chosen.profile = profile_for(options.device, options.profile);
  else
    chosen.profile = to_read_only(chosen.board);
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
