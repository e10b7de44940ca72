// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <Eigen/Core>

#include "core/wrench.h"

namespace spidar {

/// How a picture is turned or mirrored before it is shown. A telephone that is held upright stores
/// its pictures lying on their side, and the player turns them. Directions are x right, y down;
/// positions go from (0, 0), the top left corner, to (1, 1).
class Orientation {
 public:
  /// For a picture that is shown as it is stored.
  Orientation() = default;
  /// First mirrored left to right, if `mirrored`; then turned clockwise by `quarters` right angles.
  explicit Orientation(int quarters, bool mirrored = false) {
    Eigen::Matrix2d quarter;
    quarter << 0, -1, 1, 0;
    if (mirrored) turn_(0, 0) = -1;
    for (int i = 0; i < quarters; ++i) turn_ = (quarter * turn_).eval();
  }

  bool is_none() const { return turn_.isIdentity(); }
  /// Whether width becomes height.
  bool is_sideways() const { return turn_(0, 0) == 0; }

  Eigen::Vector2d to_displayed(const Eigen::Vector2d& direction) const { return turn_ * direction; }
  Eigen::Vector2d to_stored(const Eigen::Vector2d& direction) const {
    return turn_.transpose() * direction;
  }
  // Without a turn, nothing is rounded.
  Eigen::Vector2d displayed_position(const Eigen::Vector2d& position) const {
    if (is_none()) return position;
    return middle() + to_displayed(position - middle());
  }
  Eigen::Vector2d stored_position(const Eigen::Vector2d& position) const {
    if (is_none()) return position;
    return middle() + to_stored(position - middle());
  }

  /// A torque is an axial vector: mirroring the picture also reverses it.
  Wrench to_displayed(const Wrench& wrench) const {
    if (is_none()) return wrench;
    Eigen::Matrix3d in_device = Eigen::Matrix3d::Identity();
    in_device.topLeftCorner<2, 2>() = turn_;
    // y of the device points up.
    in_device(0, 1) = -in_device(0, 1);
    in_device(1, 0) = -in_device(1, 0);
    return {in_device * wrench.force_N, turn_.determinant() * (in_device * wrench.torque_Nm)};
  }

 private:
  static Eigen::Vector2d middle() { return {0.5, 0.5}; }

  Eigen::Matrix2d turn_ = Eigen::Matrix2d::Identity();
};

}  // namespace spidar
