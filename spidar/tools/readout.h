// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What a reading says: lengths and pose.
#pragma once

#include "core/grip/pose_solver.h"
#include "spidar/device.h"
#include "spidar/profiles/profile.h"

namespace spidar {

/// As the haptic loop sees it.
class Readout {
 public:
  explicit Readout(const Profile& profile)
      : profile_(profile),
        zero_length_m_(profile.zero_count_length_m()),
        solver_(profile.geometry, profile.max_pose_residual_m()) {}

  StringVector lengths_m(const DeviceReading& reading) const {
    StringVector lengths_m = StringVector::Zero();
    for (int i = 0; i < profile_.geometry.count; ++i) {
      const auto k = static_cast<size_t>(i);
      const StringDrive& drive = profile_.drives[k];
      lengths_m[i] =
          zero_length_m_[i] + drive.encoder_sign * drive.metres_per_count * reading.count[k];
    }
    return lengths_m;
  }

  PoseResult pose(const StringVector& lengths_m) { return solver_.solve(lengths_m); }

 private:
  const Profile& profile_;
  const StringVector zero_length_m_;
  PoseSolver solver_;
};

}  // namespace spidar
