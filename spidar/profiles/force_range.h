// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// How much force a device can give.
#pragma once

#include <algorithm>

#include <Eigen/Geometry>

#include "core/grip/string_geometry.h"
#include "spidar/profiles/profile.h"

namespace spidar {

/// Every device takes a limit of so much, the default, even if it cannot give that.
constexpr double kAnyForce_N = 3;

/// The upper bound of a force limit: the force that the strings can give at the centre in every
/// direction, and no less than kAnyForce_N. The forces that they can give are a sum of segments,
/// whose nearest face is parallel to two of them.
inline double largest_force_N(const Profile& profile) {
  const Eigen::Matrix<double, 3, kMaxStrings> pulls =
      structure_matrix(profile.geometry, {}).topRows<3>() * profile.max_tension_N().asDiagonal();
  double least_N = -1;
  for (int i = 0; i < profile.geometry.count; ++i) {
    for (int k = 0; k < i; ++k) {
      const Eigen::Vector3d across = pulls.col(i).cross(pulls.col(k));
      if (!(across.norm() > 0)) continue;
      const Eigen::Vector3d normal = across.normalized();
      for (const Eigen::Vector3d& towards : {normal, Eigen::Vector3d(-normal)}) {
        const double most_N = (towards.transpose() * pulls).cwiseMax(0).sum();
        least_N = least_N < 0 ? most_N : std::min(least_N, most_N);
      }
    }
  }
  return std::max(kAnyForce_N, least_N);
}

}  // namespace spidar
