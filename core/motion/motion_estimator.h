// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "core/field/block_field.h"
#include "core/field/fine_windows.h"
#include "core/motion/camera/camera_choice.h"
#include "core/motion/measured_frame.h"
#include "core/motion/objects/dominant_object.h"
#include "core/motion/objects/object_tracker.h"
#include "core/picture/reduced_frame.h"
#include "core/points/tracker.h"

namespace spidar {

/// Finds what moves between successive frames, and keeps what it needs of earlier frames. Does not
/// allocate after the first frames of a size.
class MotionEstimator {
 public:
  explicit MotionEstimator(std::shared_ptr<uint32_t> next_id = std::make_shared<uint32_t>(1))
      : objects_(std::move(next_id)) {}

  /// Takes a picture, both as it is and as `reduced`, and sets the motion in `frame`, whose
  /// `interval_ns` > 0 is the time since the previous one. Returns false when there is nothing to
  /// compare with: the first picture, another size, or a cut. `felt` is the object that was felt
  /// before; 0: none.
  bool estimate(const ImageView& image, const ReducedFrame& reduced, MeasuredFrame& frame,
                uint32_t felt = 0);

  /// Call this after a cut or a seek: the next frame is not compared with the previous one.
  void reset();

 private:
  void store_windows(const ImageView& frame, const FieldPosition& position);
  void report_points(const FieldPosition& position, std::vector<FollowedPoint>& points) const;

  BlockField field_;
  CameraChoice camera_;
  ObjectTracker objects_;
  DominantObject dominant_;
  FineWindows windows_;
  std::vector<size_t> of_objects_;  ///< indices of the blocks of all objects
};

}  // namespace spidar
