// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The grip as a pointer on the picture.
#pragma once

#include <Eigen/Core>

#include "core/grip/string_geometry.h"

namespace spidar {

/// Maps the grip's position to a place of the picture. The picture is upright in the device's xy
/// plane, its middle at the workspace's centre, and its edges half of the way to the frame, that
/// is, to the box that holds the exits of the strings: there the grip can still be held
/// (docs/workspace.md). Right is right, up is up, depth does not matter; turning the grip does not
/// move the pointer.
class GripPointer {
 public:
  /// Nothing is known of a device: everything is the middle.
  GripPointer() = default;
  explicit GripPointer(const StringGeometry& geometry);
  /// See half_size_m().
  explicit GripPointer(const Eigen::Vector2d& half_size_m) : half_size_m_(half_size_m) {}

  /// (0, 0) is the top left corner of the picture, (1, 1) its bottom right one; a grip further out
  /// points at the edge.
  Eigen::Vector2d place(const Eigen::Vector3d& position_m) const;

  /// Of the box that maps to the picture, in x and y.
  const Eigen::Vector2d& half_size_m() const { return half_size_m_; }

 private:
  Eigen::Vector2d half_size_m_ = Eigen::Vector2d::Zero();
};

}  // namespace spidar
