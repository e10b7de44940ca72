// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/grip/string_geometry.h"
#include "spidar/loop/tick_record.h"

namespace spidar {

struct DeviceView {
  std::string name;
  bool has_hand = false;         ///< whether lead_hand() moves the hand of a simulated device
  bool has_strings = true;       ///< otherwise only the size of the profile's frame matters
  TickRecord last;               ///< the newest tick
  uint64_t overruns = 0;         ///< see LoopCounters
  std::vector<ForceTick> ticks;  ///< since the last read_device(), oldest first
  StringGeometry geometry;
  StringVector min_tension_N = StringVector::Zero();
  StringVector max_tension_N = StringVector::Zero();
};

}  // namespace spidar
