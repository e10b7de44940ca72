// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/grip/string_geometry.h"

namespace spidar {

double StringGeometry::grip_radius_m() const {
  double sum = 0;
  for (int i = 0; i < count; ++i) sum += grip_m[i].norm();
  return count > 0 ? sum / count : 0.0;
}

StringVector string_lengths_m(const StringGeometry& geometry, const Pose& pose) {
  const Eigen::Matrix3d R = pose.orientation.toRotationMatrix();
  StringVector lengths = StringVector::Zero();
  for (int i = 0; i < geometry.count; ++i) {
    lengths[i] = (geometry.exit_m[i] - pose.position_m - R * geometry.grip_m[i]).norm();
  }
  return lengths;
}

StructureMatrix structure_matrix(const StringGeometry& geometry, const Pose& pose) {
  const Eigen::Matrix3d R = pose.orientation.toRotationMatrix();
  StructureMatrix W = StructureMatrix::Zero();
  for (int i = 0; i < geometry.count; ++i) {
    const Eigen::Vector3d arm = R * geometry.grip_m[i];
    const Eigen::Vector3d string = geometry.exit_m[i] - pose.position_m - arm;
    const double length = string.norm();
    if (!(length > 0)) continue;
    const Eigen::Vector3d direction = string / length;
    W.col(i) << direction, arm.cross(direction);
  }
  return W;
}

Eigen::Vector3d half_frame_m(const StringGeometry& geometry) {
  Eigen::Vector3d half_m = Eigen::Vector3d::Zero();
  for (int i = 0; i < geometry.count; ++i) half_m = half_m.cwiseMax(geometry.exit_m[i].cwiseAbs());
  return half_m;
}

}  // namespace spidar
