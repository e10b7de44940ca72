// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Smooth paths of a grip and of the wrench on it.
#pragma once

#include <cmath>
#include <random>

#include "core/grip/pose.h"
#include "core/wrench.h"

namespace spidar::test {

/// A vector that swings in each axis at its own pace: never longer than `reach`, never changing
/// faster than `rate` per second, and near to both now and then.
class SmoothVector {
 public:
  SmoothVector(std::mt19937_64& random, double reach, double rate)
      : amplitude_(reach / std::sqrt(3.0)) {
    std::uniform_real_distribution<double> pace(0.5, 1), phase(0, 2 * M_PI);
    for (int k = 0; k < 3; ++k) {
      frequency_rad_s_[k] = pace(random);
      phase_rad_[k] = phase(random);
    }
    frequency_rad_s_ *= rate / (amplitude_ * frequency_rad_s_.norm());
  }

  Eigen::Vector3d at(double time_s) const {
    return amplitude_ * (frequency_rad_s_ * time_s + phase_rad_).array().sin();
  }

 private:
  double amplitude_;
  Eigen::Vector3d frequency_rad_s_, phase_rad_;
};

/// A normal path: near the centre, with a wrench that a SPIDAR-G can give, from one end to the
/// other in a tenth of a second.
struct PathLimits {
  double reach_m = 0.02, speed_m_s = 1;
  double angle_rad = 0.35, turn_rad_s = 5;
  double force_N = 3, force_rate_N_s = 60;
  double torque_Nm = 0.03, torque_rate_Nm_s = 0.6;
};

/// As far out and as rotated as possible, in and out of the region where the strings can balance a
/// wrench.
inline PathLimits far_and_turned() {
  PathLimits limits;
  limits.reach_m = 0.04;
  limits.angle_rad = 1.2;
  return limits;
}

/// The same, with a wrench that nearly always exceeds what the motors can do.
inline PathLimits beyond_reach() {
  PathLimits limits = far_and_turned();
  limits.force_N = 60;
  limits.force_rate_N_s = 600;
  limits.torque_Nm = 0.6;
  limits.torque_rate_Nm_s = 6;
  return limits;
}

class GripPath {
 public:
  GripPath(std::mt19937_64& random, const PathLimits& limits)
      : position_m_(random, limits.reach_m, limits.speed_m_s),
        rotation_rad_(random, limits.angle_rad, limits.turn_rad_s),
        force_N_(random, limits.force_N, limits.force_rate_N_s),
        torque_Nm_(random, limits.torque_Nm, limits.torque_rate_Nm_s) {}

  /// Angular velocity is at most the rate of the rotation vector.
  Pose pose(double time_s) const {
    const Eigen::Vector3d rotation = rotation_rad_.at(time_s);
    Pose pose;
    pose.position_m = position_m_.at(time_s);
    const double angle_rad = rotation.norm();
    if (angle_rad > 0) pose.orientation = Eigen::AngleAxisd(angle_rad, rotation / angle_rad);
    return pose;
  }

  Wrench wrench(double time_s) const { return {force_N_.at(time_s), torque_Nm_.at(time_s)}; }

 private:
  SmoothVector position_m_, rotation_rad_, force_N_, torque_Nm_;
};

}  // namespace spidar::test
