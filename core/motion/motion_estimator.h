// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Finds what moves between successive frames.
#pragma once

#include <cstdint>
#include <vector>

#include "core/field/block_field.h"
#include "core/field/field_points.h"
#include "core/field/reduced_frame.h"
#include "core/motion/background.h"
#include "core/motion/dominant_object.h"
#include "core/motion/measured_frame.h"
#include "core/motion/objects.h"
#include "core/tracking/tracker.h"

namespace spidar {

/// Computes motion from frames and keeps what it needs of earlier frames. Does not allocate after
/// the first frames of a size.
class MotionEstimator {
 public:
  MotionEstimator();

  /// Takes a picture, both as it is and as `reduced`, and fills in what moves in `frame`, whose
  /// `interval_ns` > 0 is since the one before. `points` are followed for sub-pixel accuracy. False
  /// when there is nothing to compare with: the first picture, another size, or a cut.
  bool estimate(const ImageView& image, const ReducedFrame& reduced,
                const FieldPoints::Settings& points, MeasuredFrame& frame);

  /// After a cut or a seek: the next frame is not compared with the one before.
  void reset();

 private:
  enum class Voters { kTextured, kEdgesToo };

  bool collect_votes(Voters voters);
  void collect_points(const ReducedFrame& reduced, const std::vector<Track>& tracks);
  void refine_background(Background& background);
  void choose_points(const ImageView& frame, const ReducedFrame& reduced,
                     const FieldPoints::Settings& points);
  void report_tracks(const ReducedFrame& reduced, std::vector<Track>& tracks);

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
  std::vector<uint8_t> has_point_;  ///< for each block
};

}  // namespace spidar
