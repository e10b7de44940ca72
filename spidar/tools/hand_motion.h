// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A hand that moves a simulated grip through the motion that calibration needs.
#pragma once

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "core/grip/pose.h"
#include "core/grip/string_geometry.h"

namespace spidar {

/// Moves and rotates in all six directions at once, with incommensurable periods of about two to
/// four seconds: by up to 0.4 of the frame's half-width and 0.45 rad in each direction. At the
/// centre up to `time_s` = 0. Another `phase_rad` gives another motion.
inline Pose hand_in_motion(const StringGeometry& geometry, double time_s, double phase_rad = 0) {
  constexpr double kShare = 0.4, kTurn_rad = 0.45, kFadeIn_s = 1.0;
  constexpr double kRate_Hz[6] = {0.437, 0.361, 0.281, 0.251, 0.319, 0.397};
  Eigen::Vector3d half_m = Eigen::Vector3d::Zero();
  for (int i = 0; i < geometry.count; ++i)
    half_m = half_m.cwiseMax(geometry.exit_m[static_cast<size_t>(i)].cwiseAbs());
  const double grown = std::clamp(time_s / kFadeIn_s, 0.0, 1.0);
  const auto wave = [&](int i) {
    return grown * std::sin(2 * M_PI * kRate_Hz[i] * time_s + phase_rad * (1 + i));
  };
  Pose pose;
  pose.position_m = kShare * half_m.minCoeff() * Eigen::Vector3d(wave(0), wave(1), wave(2));
  const Eigen::Vector3d turn = kTurn_rad * Eigen::Vector3d(wave(3), wave(4), wave(5));
  if (turn.norm() > 0) pose.orientation = Eigen::AngleAxisd(turn.norm(), turn.normalized());
  return pose;
}

}  // namespace spidar
