// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What can be seen of an open device from outside the haptic loop.
#pragma once

#include <algorithm>
#include <string>

#include <Eigen/Core>

#include "core/grip/string_geometry.h"
#include "spidar/loop/tick_record.h"

namespace spidar {

/// What a force was in several ticks.
struct ForceSpan {
  int ticks = 0;
  Eigen::Vector3d low_N = Eigen::Vector3d::Zero(), high_N = Eigen::Vector3d::Zero();  ///< by axis
  double most_N = 0;  ///< the largest of all directions

  void add(const Eigen::Vector3d& force_N) {
    low_N = ticks == 0 ? force_N : low_N.cwiseMin(force_N).eval();
    high_N = ticks == 0 ? force_N : high_N.cwiseMax(force_N).eval();
    most_N = std::max(most_N, force_N.norm());
    ++ticks;
  }
};

struct DeviceView {
  std::string name;
  bool has_hand = false;    ///< it is simulated, and lead_hand() moves its hand
  bool has_strings = true;  ///< otherwise only the size of the profile's frame matters
  LoopSnapshot loop;
  ForceSpan wanted, delivered;  ///< since the last look
  StringGeometry geometry;
  StringVector min_tension_N = StringVector::Zero();
  StringVector max_tension_N = StringVector::Zero();
};

}  // namespace spidar
