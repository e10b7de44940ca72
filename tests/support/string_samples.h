// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <random>

#include "core/grip/string_geometry.h"

namespace spidar::test {

/// SPIDAR-G6X3 (aluminium frame, right hand) as in Springhead 2's HISpidar.cpp, z turned towards
/// the viewer.
inline StringGeometry g6x3_geometry() {
  const double exit = 0.06 * M_SQRT2, height = 0.076, arm = 0.0225, diagonal = arm / M_SQRT2;
  StringGeometry g;
  g.count = 8;
  for (int i = 0; i < 8; ++i) {
    const double y = i < 4 ? -1 : 1;
    const double corner[4][2] = {{-exit, 0}, {0, -exit}, {exit, 0}, {0, exit}};
    g.exit_m[i] = {corner[i % 4][0], y * height, corner[i % 4][1]};
    if (i % 4 == 0) g.grip_m[i] = {-diagonal, 0, diagonal};
    if (i % 4 == 1) g.grip_m[i] = {diagonal, 0, -diagonal};
    if (i % 4 >= 2) g.grip_m[i] = {0, y * arm, 0};
  }
  return g;
}

using Random = std::mt19937_64;

inline double uniform(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

inline Eigen::Vector3d random_vector(Random& random, double largest) {
  return {uniform(random, -largest, largest), uniform(random, -largest, largest),
          uniform(random, -largest, largest)};
}

inline Eigen::Vector3d random_direction(Random& random) {
  std::normal_distribution<double> normal;
  return Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
}

/// A position in a cube of ± `reach_m` about the centre, turned by up to `angle_rad` about any
/// axis.
inline Pose random_pose(Random& random, double reach_m, double angle_rad) {
  Pose pose;
  pose.position_m = random_vector(random, reach_m);
  pose.orientation = Eigen::AngleAxisd(uniform(random, 0, angle_rad), random_direction(random));
  return pose;
}

}  // namespace spidar::test
