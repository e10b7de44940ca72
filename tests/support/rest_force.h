// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include "core/grip/string_geometry.h"
#include "spidar/profiles/profile.h"

namespace spidar::test {

/// The force of the tensions at rest on a grip at this pose: away from the centre they pull it back
/// a little, whether it touches something or not.
inline Eigen::Vector3d rest_force_N(const Profile& profile, const Pose& pose) {
  const Eigen::Matrix<double, 6, 1> wrench =
      structure_matrix(profile.geometry, pose) * profile.min_tension_N();
  return wrench.head<3>();
}

}  // namespace spidar::test
