// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Finds the motion that is felt in successive frames.
#pragma once

#include <cstdint>
#include <vector>

#include "core/api.h"
#include "core/field/block_field.h"
#include "core/field/field_points.h"
#include "core/field/reduced_frame.h"
#include "core/motion/background.h"
#include "core/motion/dominant_object.h"
#include "core/motion/image_motion.h"
#include "core/motion/objects.h"
#include "core/motion/scene_motion.h"
#include "core/tracking/tracker.h"

namespace spidar {

/// Frames → motion. Keeps what must be known of the frames before. Takes no memory from the heap
/// after the first frames of a size.
class SPIDAR_API MotionEstimator {
 public:
  MotionEstimator();

  /// What is looked at beside the field of blocks.
  struct Points {
    /// Tracks of the frame by somebody else; null: the estimator follows points of its own.
    const TrackedFrame* given = nullptr;
    FieldPoints::Settings own;
  };

  /// The frame that was shown `interval_ns` > 0 after the one before, in whole and `reduced`.
  /// kMean is the mean of the points given, which it needs; all others look at the frame itself and
  /// take points for the last fraction of a pixel. `pointer` is a place of the picture, (0, 0) its
  /// top left and (1, 1) its bottom right corner; it may lie outside. Only kObjects looks at it.
  /// Another kind than in the frame before begins anew where it needs what that one did not keep.
  SceneMotion estimate(MotionKind kind, const ImageView& frame, const ReducedFrame& reduced,
                       const Points& points, int64_t interval_ns,
                       const Eigen::Vector2d& pointer = {0.5, 0.5});

  /// A cut, a seek: the next frame has nothing to do with the one before.
  void reset();

 private:
  void drop_unneeded(MotionKind kind);
  void collect_votes();
  void collect_points(const ReducedFrame& reduced, const std::vector<Track>& tracks);
  void refine_background(Background& background);
  void choose_points(const ImageView& frame, const ReducedFrame& reduced, const Points& points);
  void report_tracks(const ReducedFrame& reduced, const std::vector<Track>& followed);

  MotionKind kind_ = MotionKind::kMean;
  BlockField field_;
  BackgroundVotes votes_;
  BackgroundEstimator estimator_;
  ObjectTracker objects_;
  DominantObject dominant_;
  FieldPoints points_;
  RobustFitter fitter_;
  WeightedDisplacements evidence_;
  std::vector<PlacedPoint> placed_;
  std::vector<PointWish> wishes_;
  std::vector<uint8_t> has_point_;  ///< of each block
  std::vector<Track> tracks_;
  Background background_;  ///< in px of the frame
};

}  // namespace spidar
