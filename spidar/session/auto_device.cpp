// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/session/auto_device.h"

#include <algorithm>

#include "spidar/devices/device_registry.h"
#include "spidar/session/board_list.h"
#include "spidar/session/device_factory.h"
#include "spidar/session/profile_choice.h"

namespace spidar {
namespace {

/// In the order in which they are tried.
struct Rank {
  const char* device;
  bool directional;
  const char* why;
};
constexpr Rank kForces[] = {
    {"ff", true, "a joystick or wheel with directional force"},
    {"inverse3", true, "a Haply Inverse3"},
    {"falcon", true, "a Novint Falcon"},
    {"ff", false, "a gamepad that rumbles"},
};

std::string unconfirmed(const BoardInfo& board) {
  const std::string named = "device=" + board.device + " profile=NAME";
  const std::string once = "spidarctl choose " + board.device + " --profile NAME";
  return "this " + board.name + " has no confirmed profile, without which its motors get no force" +
         (board.memory_error.empty() ? "" : " (" + board.memory_error + ")") +
         (board.serial.empty() ? "; name it each time: " + named : "; confirm it: " + once) + " (" +
         fitting_text(board) + ")";
}

}  // namespace

std::vector<AutoDevice> auto_devices() {
  std::vector<AutoDevice> found;
  const std::vector<BoardInfo> boards = list_boards();
  for (const BoardInfo& board : boards)
    if (board.has_strings && !board.profile.empty() && !is_simulated(board.device))
      found.push_back({board.device, "a SPIDAR whose profile was confirmed", ""});
  for (const BoardInfo& board : boards)
    if (board.has_strings && board.profile.empty())
      found.push_back({board.device, "", unconfirmed(board)});
  for (const Rank& rank : kForces) {
    for (const BoardInfo& board : boards)
      if (DeviceName(board.device).device == rank.device && board.directional == rank.directional)
        found.push_back({board.device, rank.why, ""});
  }
  for (const BoardInfo& board : boards)
    if (DeviceName(board.device).device == "mouse")
      found.push_back({board.device, "", "a " + board.name + " is used only with device=mouse"});
  return found;
}

}  // namespace spidar
