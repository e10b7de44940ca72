// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Tension problems that the haptic loop poses for a profile, and harder ones.
#pragma once

#include <cmath>

#include "core/grip/tension_solver.h"
#include "spidar/profiles/profile.h"
#include "tests/support/string_samples.h"

namespace spidar::test {

/// Poses from the centre to outside the frame, rotated arbitrarily; wrenches from none to ten times
/// the largest tension. Bounds, reference and torque length as in HapticLoop. In some cases one
/// string is given up (its bounds coincide), or ε vanishes beside WᵀS²W.
inline TensionProblem random_problem(Random& random, const Profile& profile) {
  Eigen::Vector3d frame_m = Eigen::Vector3d::Zero();
  for (int i = 0; i < profile.geometry.count; ++i)
    frame_m = frame_m.cwiseMax(profile.geometry.exit_m[static_cast<size_t>(i)].cwiseAbs());
  constexpr double kReach[] = {0.3, 0.9, 1.1, 3};  // fractions of the frame
  constexpr double kAngle[] = {0.35, 1.4, M_PI};

  TensionProblem p;
  Pose pose;
  pose.position_m = random_vector(random, kReach[random() % 4]).cwiseProduct(frame_m);
  pose.orientation =
      Eigen::AngleAxisd(uniform(random, 0, kAngle[random() % 3]), random_direction(random));
  p.count = profile.geometry.count;
  p.W = structure_matrix(profile.geometry, pose);
  p.t_min_N = profile.min_tension_N();
  p.t_max_N = profile.max_tension_N();
  p.t_ref_N = p.t_min_N;
  const double radius_m = profile.geometry.grip_radius_m();
  if (radius_m > 0) p.torque_length_m = radius_m;
  const double force_N = p.t_max_N.maxCoeff() * std::pow(10.0, uniform(random, -2, 1));
  if (random() % 8)
    p.wrench = {uniform(random, 0, force_N) * random_direction(random),
                uniform(random, 0, force_N) * p.torque_length_m * random_direction(random)};
  if (random() % 8 == 0) {
    const auto i = static_cast<Eigen::Index>(random() % static_cast<unsigned>(p.count));
    p.t_max_N[i] = p.t_min_N[i];
  }
  if (random() % 8 == 0) p.epsilon = std::pow(10.0, uniform(random, -12, -4));
  return p;
}

}  // namespace spidar::test
