// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// String lengths and pose of a reading.
#pragma once

#include "core/grip/pose_solver.h"
#include "spidar/device.h"
#include "spidar/profiles/encoder_scale.h"

namespace spidar {

/// Computes lengths and pose from a reading as the haptic loop does.
class Readout {
 public:
  explicit Readout(const Profile& profile)
      : encoders_(profile), solver_(profile.geometry, profile.max_pose_residual_m()) {}

  StringVector lengths_m(const DeviceReading& reading) const {
    return encoders_.lengths_m(reading.count);
  }

  PoseResult pose(const StringVector& lengths_m) { return solver_.solve(lengths_m); }

 private:
  const EncoderScale encoders_;
  PoseSolver solver_;
};

}  // namespace spidar
