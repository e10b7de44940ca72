// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The hand of a simulated device, moved to a position that the user chooses.
#pragma once

#include <Eigen/Core>

#include "core/grip/pose.h"

namespace spidar {

/// Target of the hand in the device frame.
struct HandLead {
  bool leads = false;  ///< false: return to the resting pose
  Eigen::Vector3d to_m = Eigen::Vector3d::Zero();
};

/// Moves the hand towards its target at a limited speed. Without a target it returns to its resting
/// pose, and then stays exactly there.
class LedHand {
 public:
  /// Speed of a brisk stroke. People explore surfaces at 0.01 … 0.25 m/s (R. Klatzky and S.
  /// Lederman, Tactile roughness perception with a rigid link interposed between skin and surface,
  /// Perception & Psychophysics 61, 1999), and reach faster.
  static constexpr double kFastest_m_s = 0.5;

  /// Returns the pose of the hand `dt_s` ≥ 0 later. Neither allocates nor throws.
  const Pose& follow(const Pose& rest, const HandLead& lead, double dt_s) noexcept;

 private:
  bool away_ = false;  ///< not at the resting pose
  Pose pose_;
};

}  // namespace spidar
