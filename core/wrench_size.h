// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cmath>

#include "core/wrench.h"

namespace spidar {

/// The lever arm of the torque: the radius of the grip of a SPIDAR-G. One newton at this arm counts
/// as much as a force of one newton.
constexpr double kTorqueArm_m = 0.0225;

/// The smallest force that a hand feels, averaged over wrist, elbow and shoulder: IEEE Trans.
/// Haptics 2013, PubMed 24808327.
constexpr double kFeltForce_N = 0.04;

/// The magnitude of a wrench as one force, with the torque divided by `arm_m` > 0.
inline double size_N(const Wrench& wrench, double arm_m = kTorqueArm_m) noexcept {
  return std::hypot(wrench.force_N.norm(), wrench.torque_Nm.norm() / arm_m);
}

}  // namespace spidar
