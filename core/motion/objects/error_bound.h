// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// How far the measured motion of an object may be from the true one.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "core/motion/layers/regions.h"
#include "core/motion/objects/moving_object.h"
#include "core/motion/objects/object_motion.h"

namespace spidar {

/// Combines four errors, which are independent of each other:
/// - how far the object's blocks are from its motion: the standard error of their median;
/// - what the noise of the pixels makes of the object's texture, in the direction in which it has
///   least: along an edge the error is large, though all blocks of the edge agree;
/// - how far the background beside the object is from the background's model;
/// - how far the interpolation between pixels moves all blocks of the object or of the background
///   alike.
class ErrorBound {
 public:
  ErrorBound();

  /// The error of `found.relative_px`, the motion of the object `key`, is shorter than this in 95 %
  /// of frames, px of the field's picture.
  double px(uint32_t key, const Region& region, const ObjectMotion& found,
            const ObjectEvidence& evidence);

  /// The same of what the object's own blocks show alone, without the errors that they share with
  /// each other and with the background. Those last for many frames; this one differs from frame to
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
