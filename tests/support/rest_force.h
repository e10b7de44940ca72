// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The force of strings at rest.
#pragma once

#include "core/grip/string_geometry.h"
#include "spidar/profiles/profile.h"

namespace spidar::test {

/// Of the tensions at rest on a grip that is there: away from the centre they pull it back a
/// little, whether anything is touched or not.
inline Eigen::Vector3d rest_force_N(const Profile& profile, const Pose& pose) {
  const Eigen::Matrix<double, 6, 1> wrench =
      structure_matrix(profile.geometry, pose) * profile.min_tension_N();
  return wrench.head<3>();
}

}  // namespace spidar::test
