// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "core/field/block_field.h"
#include "core/field/fine_windows.h"
#include "core/motion/camera/background.h"
#include "core/motion/camera/motion_models.h"
#include "core/motion/layers/moving_blocks.h"
#include "core/motion/layers/regions.h"
#include "core/motion/objects/moving_object.h"

namespace spidar {

/// The evidence of an object's motion. Lengths are in px of the field's picture.
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
  int points = 0;               ///< number of windows or blocks
};

/// Measures the motion of one object from its blocks or, to a fraction of a pixel, from its windows
/// if there are enough. Includes rotation and growth if the GRIC prefers them.
class ObjectMeter {
 public:
  ObjectMeter();

  /// `region` is the region of the object `key`.
  ObjectMotion measure(uint32_t key, const Region& region, const ObjectEvidence& evidence);

 private:
  void collect_blocks(uint32_t key, const ObjectEvidence& evidence);
  bool collect_windows(uint32_t key, const MotionModel& motion, const ObjectEvidence& evidence);
  void choose_similarity(MotionModel& motion);

  WeightedDisplacements collected_;
};

/// Combines four errors, which are independent of each other:
/// - how far the object's blocks are from its motion: the standard error of their median;
/// - the effect of pixel noise on the object's texture, in the weakest direction: along an edge the
///   error is large, though all blocks of the edge agree;
/// - how far the background beside the object is from the background's model;
/// - how far the interpolation between pixels moves all blocks of the object or of the background
///   alike.
class ErrorBound {
 public:
  ErrorBound();

  /// In 95 % of frames, the error of `found.relative_px`, the motion of the object `key`, is
  /// shorter than this, px of the field's picture.
  double px(uint32_t key, const Region& region, const ObjectMotion& found,
            const ObjectEvidence& evidence);

  /// The same for the object's own blocks alone, without the errors that they share with each other
  /// and with the background. Shared errors last for many frames; this one differs from frame to
  /// frame.
  double own_px(uint32_t key, const ObjectMotion& found, const ObjectEvidence& evidence) {
    return kErrorSigmas * std::sqrt(own_variance_px2(key, found, evidence));
  }

 private:
  double own_variance_px2(uint32_t key, const ObjectMotion& found, const ObjectEvidence& evidence);
  double background_variance_px2(const Region& region, const ObjectEvidence& evidence);

  std::vector<double> squares_px2_;         ///< distances of the blocks from the object's motion
  std::vector<Eigen::Vector2f> beside_px_;  ///< motion of blocks beside the object
};

}  // namespace spidar
