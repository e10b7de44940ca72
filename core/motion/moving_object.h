// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What moves beyond the background.
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "core/motion/motion_models.h"

namespace spidar {

/// One object in one frame. Image frame I about the centre of the frame: x right, y down.
struct MovingObject {
  uint32_t id = 0;  ///< the same for as long as it lives, never used again
  Eigen::Vector2d position_px = Eigen::Vector2d::Zero();     ///< of its middle
  Eigen::Vector2d size_px = Eigen::Vector2d::Zero();         ///< of the box around it
  Eigen::Vector2d relative_px_s = Eigen::Vector2d::Zero();   ///< velocity against the background
  Eigen::Vector2d on_screen_px_s = Eigen::Vector2d::Zero();  ///< velocity that the viewer sees
  double growth_1_s = 0;                                     ///< see ImageMotion, both against …
  double roll_rad_s = 0;                                     ///< … the background
  ModelKind model = ModelKind::kTranslation;                 ///< translation or similarity
  int tracks = 0;         ///< points or blocks it was measured with; 0: out of sight
  double noise_px_s = 0;  ///< standard error of each coordinate of relative_px_s
  double area_px2 = 0;    ///< of its blocks
  double prominence = 0;  ///< what one would look at, see salience()
};

}  // namespace spidar
