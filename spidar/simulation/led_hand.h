// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The hand of a simulated device, led to a place by whoever watches it.
#pragma once

#include <Eigen/Core>

#include "core/api.h"
#include "core/grip/pose.h"

namespace spidar {

/// Where a hand is led to, device frame.
struct HandLead {
  bool leads = false;  ///< false: back to its resting pose
  Eigen::Vector3d to_m = Eigen::Vector3d::Zero();
};

/// Moves a hand no faster than people move theirs over a surface. As long as it is not led it is
/// exactly at its resting pose.
class SPIDAR_API LedHand {
 public:
  /// A brisk stroke. People explore surfaces at 0.01 … 0.25 m/s (R. Klatzky and S. Lederman,
  /// Tactile roughness perception with a rigid link interposed between skin and surface,
  /// Perception & Psychophysics 61, 1999), and reach faster.
  static constexpr double kFastest_m_s = 0.5;

  /// Where the hand is `dt_s` ≥ 0 later. Neither allocates nor throws.
  const Pose& follow(const Pose& rest, const HandLead& lead, double dt_s) noexcept;

 private:
  bool away_ = false;  ///< from its resting pose
  Pose pose_;
};

}  // namespace spidar
