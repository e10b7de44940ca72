// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Where the grip is.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace spidar {

/// T_D_G: maps points of the grip frame G to the device frame D.
struct Pose {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
};

}  // namespace spidar
