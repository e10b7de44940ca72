// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// How much force and torque a device can give.
#pragma once

#include <algorithm>

#include <Eigen/Geometry>

#include "core/grip/string_geometry.h"
#include "spidar/profiles/profile.h"

namespace spidar {

/// Every device takes limits of so much, the defaults, even if it cannot give that.
constexpr double kAnyForce_N = 3;
constexpr double kAnyTorque_Nm = 0.1;

/// How far the sum of these pulls, each from none to full, reaches in its weakest direction. What
/// they reach is a sum of segments, whose nearest face is parallel to two of them. −1 when they all
/// lie in one line.
inline double least_reach(const Eigen::Matrix<double, 3, kMaxStrings>& pulls, int count) {
  double least = -1;
  for (int i = 0; i < count; ++i) {
    for (int k = 0; k < i; ++k) {
      const Eigen::Vector3d across = pulls.col(i).cross(pulls.col(k));
      if (!(across.norm() > 0)) continue;
      const Eigen::Vector3d normal = across.normalized();
      for (const Eigen::Vector3d& towards : {normal, Eigen::Vector3d(-normal)}) {
        const double most = (towards.transpose() * pulls).cwiseMax(0).sum();
        least = least < 0 ? most : std::min(least, most);
      }
    }
  }
  return least;
}

/// The upper bound of a force limit: the force that the strings can give at the centre in every
/// direction, and no less than kAnyForce_N.
inline double largest_force_N(const Profile& profile) {
  return std::max(kAnyForce_N, least_reach(structure_matrix(profile.geometry, {}).topRows<3>() *
                                               profile.max_tension_N().asDiagonal(),
                                           profile.geometry.count));
}

/// Largest torque limit: the torque that the strings can give at the centre about every axis, and
/// no less than kAnyTorque_Nm.
inline double largest_torque_Nm(const Profile& profile) {
  return std::max(kAnyTorque_Nm,
                  least_reach(structure_matrix(profile.geometry, {}).bottomRows<3>() *
                                  profile.max_tension_N().asDiagonal(),
                              profile.geometry.count));
}

}  // namespace spidar
