// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// How one object moves, from its blocks and from the points on it.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "core/field/block_field.h"
#include "core/motion/background.h"
#include "core/motion/motion_models.h"
#include "core/motion/moving_blocks.h"
#include "core/motion/regions.h"
#include "core/motion/robust_fit.h"

namespace spidar {

/// A point that was followed, in px of the field's picture from its centre.
struct PlacedPoint {
  size_t block = 0;  ///< that it is in now
  Displacement moved;
};

/// What there is to measure an object by. Lengths in px of the field's picture.
struct ObjectEvidence {
  const BlockField& field;
  const std::vector<RelativeBlock>& relative;  ///< of each block
  const std::vector<uint32_t>& owners;         ///< object of each block, 0 for none
  const std::vector<PlacedPoint>& points;
  const Background& background;
};

/// Motion of an object against the background, px of the field's picture.
struct ObjectMotion {
  MotionModel model;            ///< translation or similarity
  Eigen::Vector2d relative_px;  ///< of the middle of the object
  double sigma_px = 0;          ///< noise of what it was measured with
  int tracks = 0;               ///< points or blocks it was measured with
  bool is_rigid = false;        ///< its points agree with one motion
};

/// The blocks tell how an object moves, and the points on it to a fraction of a pixel where there
/// are enough of them. It turns or grows when the GRIC finds that worth its price.
class ObjectMeter {
 public:
  ObjectMeter();

  /// `region` is where the object `id` is.
  ObjectMotion measure(uint32_t id, const Region& region, const ObjectEvidence& evidence);

 private:
  void collect_blocks(uint32_t id, const Region& region, const ObjectEvidence& evidence);
  bool collect_points(uint32_t id, const Region& region, const MotionModel& motion,
                      const ObjectEvidence& evidence);
  void climb(MotionModel& motion);

  RobustFitter fitter_;
  WeightedDisplacements collected_;
};

}  // namespace spidar
