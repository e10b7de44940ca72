// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// All that is known of one frame.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "core/choice/object_choice.h"
#include "core/motion/image_motion.h"
#include "core/motion/measured_frame.h"
#include "core/wrench.h"

namespace spidar {

/// The result for one frame: the steps of the analysis fill it in, one after the other, and all
/// other code reads it.
struct Frame : MeasuredFrame {
  Chosen choice;  ///< without `object`
  /// Height of the film as it is shown, in the unit of its lengths: what speeds refer to.
  int shown_height_px = 0;
  uint32_t felt_object = 0;  ///< id of the one object that is felt; 0: none, or not one alone
  ImageMotion motion;        ///< the one that is felt, unfiltered, in px/s of the frame
  Wrench wrench;  ///< wanted by the controller, before any safety limit; turned and weakened as it
                  ///< is shown

  bool has_motion_before() const { return picture != Likeness::kFirst; }
  /// Whether the previous picture is shown again and its wrench goes on. At rest there is no wrench
  /// to go on.
  bool is_continuation() const {
    return picture == Likeness::kWaiting && !wrench.stacked().isZero(0);
  }
  /// Forgets everything, but keeps the memory.
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
