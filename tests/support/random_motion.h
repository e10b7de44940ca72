// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstdint>
#include <random>

#include "core/grip/string_geometry.h"

namespace spidar::test {

class RandomMotion {
 public:
  explicit RandomMotion(uint64_t seed) : random_(seed) {}

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  bool chance(double p) { return uniform(0, 1) < p; }
  /// Returns one of 0 … below − 1.
  int some(int below) { return std::uniform_int_distribution<int>(0, below - 1)(random_); }
  /// Returns a unit vector, uniform over the sphere.
  Eigen::Vector3d direction() {
    std::normal_distribution<double> normal;
    return Eigen::Vector3d(normal(random_), normal(random_), normal(random_)).normalized();
  }
  Pose pose(double reach_m, double turn_rad) {
    Pose pose;
    pose.position_m = uniform(0, reach_m) * direction();
    pose.orientation = Eigen::AngleAxisd(uniform(0, turn_rad), direction());
    return pose;
  }

 private:
  std::mt19937_64 random_;
};

}  // namespace spidar::test
