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

/// The result for one frame. The stages of the analysis fill it in one after the other; all other
/// code only reads it.
struct Frame : MeasuredFrame {
  Chosen choice;  ///< without `object`
  /// The height of the film as displayed, in px of the frame: the reference for speeds.
  int shown_height_px = 0;
  uint32_t felt_object = 0;  ///< id of the one object that is felt; 0: none, or several
  ImageMotion motion;        ///< the felt motion, unfiltered, in px/s of the frame
  /// The wanted wrench, before any safety limit. In reports, it is turned and weakened as rendered.
  Wrench wrench;

  bool has_motion_before() const { return picture != FrameComparison::kFirst; }
  /// Whether the frame repeats the previous picture and its wrench continues. At rest, none does.
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
