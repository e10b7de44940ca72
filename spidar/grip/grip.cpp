// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/grip/grip.h"

#include <cstdio>

namespace spidar {
namespace {

std::string directions_text(const std::array<bool, 3>& force) {
  constexpr std::array<const char*, 3> kDirections{"to the sides", "up and down",
                                                   "towards and away from you"};
  std::string text;
  bool all = true;
  for (size_t i = 0; i < force.size(); ++i) {
    if (force[i]) text += (text.empty() ? "" : ", ") + std::string(kDirections[i]);
    all = all && force[i];
  }
  return all ? "in every direction" : text.empty() ? "in no direction" : text;
}

}  // namespace

std::string rendered_text(const GripAbilities& can) {
  char most[32];
  std::snprintf(most, sizeof most, "%.1f N", can.largest_force_N);
  if (!can.direction) {
    return std::string("the strength of the force, not its direction, up to ") + most;
  }
  return "force " + directions_text(can.force) + ", up to " + most +
         (can.torque ? ", and torque" : ", no torque");
}

}  // namespace spidar
