// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "core/choice/object_choice.h"
#include "core/motion/image_motion.h"
#include "core/motion/measured_frame.h"
#include "core/wrench.h"

namespace spidar {

/// The result for one frame, which the steps of the analysis fill in one after the other. All other
/// code reads this.
struct Frame : MeasuredFrame {
  Chosen choice;  ///< without `object`
  /// The height of the film as shown, in the unit of its lengths, to which speeds refer.
  int shown_height_px = 0;
  uint32_t felt_object = 0;  ///< id of the one object that is felt; 0: none, or several
  ImageMotion motion;        ///< the felt one, unfiltered, in px/s of the frame
  /// Wanted by the controller, before any safety limit; turned and weakened as shown.
  Wrench wrench;

  bool has_motion_before() const { return picture != FrameComparison::kFirst; }
  /// Whether the frame repeats the previous picture, whose wrench continues; at rest none does.
  bool is_continuation() const {
    return picture == FrameComparison::kWaiting && !wrench.stacked().isZero(0);
  }
  void clear() {
    std::vector<FollowedPoint> kept_points = std::move(points);
    std::vector<MovingObject> kept_objects = std::move(objects);
    *this = Frame();
    points = std::move(kept_points);
    objects = std::move(kept_objects);
    clear_motion();
  }
};

}  // namespace spidar
