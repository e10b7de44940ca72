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

/// What shows the motion of the objects of a frame. Lengths are in px of the field's picture.
struct ObjectEvidence {
  const BlockField& field;
  const std::vector<RelativeBlock>& relative;  ///< for each block
  const std::vector<uint32_t>& owners;         ///< for each block, the key of its object, or 0
  const std::vector<FineMotion>& fine;         ///< motion of FineWindows
  const Background& background;
};

/// The motion of an object relative to the background, in px of the field's picture.
struct ObjectMotion {
  MotionModel model;            ///< translation or similarity
  Eigen::Vector2d relative_px;  ///< motion of the middle of the object
  int points = 0;               ///< number of the windows or blocks that were used
};

/// Measures the motion of one object from its windows (FineWindows), which show fractions of a
/// pixel, or from its blocks if it has too few windows. The motion is a similarity, with rotation
/// and growth, if the GRIC (background.h) prefers it to a translation.
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

/// A bound of the error of an object's motion, from four independent errors:
/// - the scatter of the object's blocks about the motion: the standard error of their median;
/// - the effect of pixel noise on the object's texture, in the weakest direction: along an edge the
///   error is large, though all blocks of the edge agree;
/// - the difference between the motion of the background beside the object and the model of the
///   background;
/// - the error of the interpolation between pixels, which all blocks of the object share, and all
///   of the background.
class ErrorBound {
 public:
  ErrorBound();

  /// The length, in px of the field's picture, that the error of `found.relative_px` does not
  /// exceed in 95 % of frames. `found` is the motion of the object `key`.
  double px(uint32_t key, const Region& region, const ObjectMotion& found,
            const ObjectEvidence& evidence);

  /// The same bound for the errors of single blocks alone, which differ from frame to frame. The
  /// errors that blocks share with each other or with the background last for many frames.
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
