// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "plugin/frame/frame_report.h"

namespace spidar {

/// Ids of the visible objects whose motion is felt: one, or all with MotionKind::kObjects when none
/// was chosen; none while only the surface is felt.
std::vector<uint32_t> felt_objects(const DrawnFrame& report);

/// The start of the force arrow, in pixels of the frame: one of the points of the single felt
/// object, otherwise the middle of the film.
Eigen::Vector2d force_origin_px(const DrawnFrame& report);

/// An object's box, in pixels of the frame, of which `film` is the part that was analysed.
Eigen::AlignedBox2d box_px(const MovingObject& object, const PicturePart& film);

/// Assigns points to the background or to objects for display, over several frames.
class PointOwners {
 public:
  /// Fills in `points`, `lost` and `felt` of an analysed frame.
  void find(DrawnFrame& report);
  /// Call this before frames that are not analysed.
  void reset() { compares_ = false; }

 private:
  void compare(DrawnFrame& report);

  std::vector<OwnedPoint> before_;
  bool compares_ = false;  ///< whether points of the previous frame are known
};

}  // namespace spidar
