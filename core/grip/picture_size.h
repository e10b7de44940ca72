// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// How large a picture is in the device's frame.
#pragma once

#include <Eigen/Core>

#include "core/grip/string_geometry.h"

namespace spidar {

/// Half the width and height of a picture, whose middle is the workspace's centre: half of the way
/// to the box that holds the exits of the strings. There the grip can still be held
/// (docs/workspace.md).
inline Eigen::Vector2d half_picture_m(const StringGeometry& geometry) {
  constexpr double kReach = 0.5;
  Eigen::Vector2d half_m = Eigen::Vector2d::Zero();
  for (int i = 0; i < geometry.count; ++i)
    half_m = half_m.cwiseMax(kReach * geometry.exit_m[static_cast<size_t>(i)].head<2>().cwiseAbs());
  return half_m;
}

}  // namespace spidar
