// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Geometry of the strings: lengths and structure matrix.
#pragma once

#include <array>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace spidar {

/// T_D_G: maps points of the grip frame G to the device frame D.
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
  std::array<Eigen::Vector3d, kMaxStrings> grip_m{};  ///< where it is tied to the grip, in G

  /// Mean distance of the grip points from the grip's origin, metres: the lever ℓ that makes
  /// torques comparable with forces.
  double grip_radius_m() const;
};

/// Lengths from exit to grip point, metres.
StringVector string_lengths_m(const StringGeometry& geometry, const Pose& pose);

/// W with wrench = W · tensions: column i is [u_i; (R g_i) × u_i], u_i the unit vector from the
/// grip point to the exit. A string of no length has no direction: its column is zero.
StructureMatrix structure_matrix(const StringGeometry& geometry, const Pose& pose);

}  // namespace spidar
