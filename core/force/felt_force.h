// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What a hand feels of a wrench.
#pragma once

#include <cmath>

#include "core/force/motion_rendering.h"
#include "core/wrench.h"

namespace spidar {

/// The smallest force that a hand feels, the mean of wrist, elbow and shoulder: IEEE Trans. Haptics
/// 2013, PubMed 24808327.
constexpr double kFeltForce_N = 0.04;

/// Size of a wrench as one force, with torque divided by the arm kTorqueArm_m (see
/// render_motion()).
inline double size_N(const Wrench& wrench) noexcept {
  return std::hypot(wrench.force_N.norm(), wrench.torque_Nm.norm() / kTorqueArm_m);
}

}  // namespace spidar
