// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <array>

#include <Eigen/Geometry>

namespace spidar {

/// T_D_G, which maps points of the grip frame G to the device frame D.
struct Pose {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
};

constexpr int kMaxStrings = 8;

/// One value for each string; entries from `count` on are unused and zero.
using StringVector = Eigen::Matrix<double, kMaxStrings, 1>;

/// Columns are strings, rows force x, y, z (1) and torque x, y, z (m); unused columns are zero.
using StructureMatrix = Eigen::Matrix<double, 6, kMaxStrings>;

struct StringGeometry {
  int count = 0;                                      ///< 1 … kMaxStrings
  std::array<Eigen::Vector3d, kMaxStrings> exit_m{};  ///< where the string leaves the frame, in D
  /// Where the string is tied to the grip, in G.
  std::array<Eigen::Vector3d, kMaxStrings> grip_m{};

  /// Mean distance of the grip points from the grip's origin, metres: the lever ℓ that makes
  /// torques comparable with forces.
  double grip_radius_m() const;
};

StringVector string_lengths_m(const StringGeometry& geometry, const Pose& pose);

/// W with wrench = W · tensions: column i is [u_i; (R g_i) × u_i], u_i the unit vector from the
/// grip point to the exit. A string of zero length has no direction: its column is zero.
StructureMatrix structure_matrix(const StringGeometry& geometry, const Pose& pose);

/// Half the size of the box about the workspace's centre that holds the exits of the strings.
Eigen::Vector3d half_frame_m(const StringGeometry& geometry);

/// How far the grip may move from the workspace's centre to each side: half of half_frame_m(),
/// where the strings can still hold it (docs/strings.md).
inline Eigen::Vector3d half_workspace_m(const StringGeometry& geometry) {
  constexpr double kReach = 0.5;
  return kReach * half_frame_m(geometry);
}

/// The geometry, stretched until half_workspace_m() is `half_m` in the axes in which `half_m` is
/// above 0: for a device without strings, which has its own workspace.
inline StringGeometry with_workspace(StringGeometry geometry, const std::array<double, 3>& half_m) {
  const Eigen::Vector3d before_m = half_workspace_m(geometry);
  for (int axis = 0; axis < 3; ++axis) {
    const double wanted_m = half_m[static_cast<size_t>(axis)];
    if (!(wanted_m > 0 && before_m[axis] > 0)) continue;
    for (Eigen::Vector3d& exit_m : geometry.exit_m) exit_m[axis] *= wanted_m / before_m[axis];
  }
  return geometry;
}

/// Half the width and height of a picture, whose middle is the workspace's centre.
inline Eigen::Vector2d half_picture_m(const StringGeometry& geometry) {
  return half_workspace_m(geometry).head<2>();
}

}  // namespace spidar
