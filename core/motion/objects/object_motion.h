// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Measures the motion of one object from its blocks and the windows on it.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "core/field/block_field.h"
#include "core/field/fine_windows.h"
#include "core/motion/camera/background.h"
#include "core/motion/camera/motion_models.h"
#include "core/motion/camera/robust_fit.h"
#include "core/motion/layers/moving_blocks.h"
#include "core/motion/layers/regions.h"

namespace spidar {

/// Everything from which an object's motion is measured. Lengths are in px of the field's picture.
struct ObjectEvidence {
  const BlockField& field;
  const std::vector<RelativeBlock>& relative;  ///< for each block
  const std::vector<uint32_t>& owners;         ///< for each block, the key of its object; 0: none
  const std::vector<FineMotion>& fine;
  const Background& background;
};

/// Motion of an object relative to the background, px of the field's picture.
struct ObjectMotion {
  MotionModel model;            ///< translation or similarity
  Eigen::Vector2d relative_px;  ///< of the middle of the object
  int points = 0;               ///< number of windows or blocks that were used
};

/// Blocks give the motion of an object; the windows on it, where there are enough, give it to a
/// fraction of a pixel. Rotation and growth are used when the GRIC prefers them.
class ObjectMeter {
 public:
  ObjectMeter();

  /// `region` is the region of the object `key`.
  ObjectMotion measure(uint32_t key, const Region& region, const ObjectEvidence& evidence);

 private:
  void collect_blocks(uint32_t key, const ObjectEvidence& evidence);
  bool collect_windows(uint32_t key, const MotionModel& motion, const ObjectEvidence& evidence);
  void climb(MotionModel& motion);

  RobustFitter fitter_;
  WeightedDisplacements collected_;
};

}  // namespace spidar
