// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// How much room the grip has, and how large a picture is in it.
#pragma once

#include <array>

#include <Eigen/Core>

#include "core/grip/string_geometry.h"

namespace spidar {

/// How far the grip is to move from the workspace's centre to each side: half of the way to the box
/// that holds the exits of the strings. There it can still be held (docs/strings.md).
inline Eigen::Vector3d half_room_m(const StringGeometry& geometry) {
  constexpr double kReach = 0.5;
  Eigen::Vector3d half_m = Eigen::Vector3d::Zero();
  for (int i = 0; i < geometry.count; ++i) {
    half_m = half_m.cwiseMax(kReach * geometry.exit_m[static_cast<size_t>(i)].cwiseAbs());
  }
  return half_m;
}

/// Stretched until half_room_m() is `half_m`, in the axes in which that is not zero: for a device
/// without strings, which has room of its own.
inline StringGeometry with_room(StringGeometry geometry, const std::array<double, 3>& half_m) {
  const Eigen::Vector3d before_m = half_room_m(geometry);
  for (int axis = 0; axis < 3; ++axis) {
    const double wanted_m = half_m[static_cast<size_t>(axis)];
    if (!(wanted_m > 0 && before_m[axis] > 0)) continue;
    for (Eigen::Vector3d& exit_m : geometry.exit_m) exit_m[axis] *= wanted_m / before_m[axis];
  }
  return geometry;
}

/// Half the width and height of a picture, whose middle is the workspace's centre.
inline Eigen::Vector2d half_picture_m(const StringGeometry& geometry) {
  return half_room_m(geometry).head<2>();
}

}  // namespace spidar
