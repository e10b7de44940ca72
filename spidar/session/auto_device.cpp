// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/session/auto_device.h"

#include <algorithm>

#include "spidar/session/board_list.h"
#include "spidar/session/device_factory.h"
#include "spidar/session/device_registry.h"

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

}  // namespace

std::vector<AutoDevice> auto_devices() {
  std::vector<AutoDevice> found;
  const std::vector<BoardInfo> boards = list_boards();
  for (const BoardInfo& board : boards)
    if (board.has_strings && !board.profile.empty() && !is_simulated(board.device))
      found.push_back({board.device, "a SPIDAR whose profile was confirmed"});
  for (const Rank& rank : kForces) {
    for (const BoardInfo& board : boards)
      if (DeviceName(board.device).device == rank.device && board.directional == rank.directional)
        found.push_back({board.device, rank.why});
  }
  return found;
}

}  // namespace spidar
