// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A point of the patch tracker.
#pragma once

#include <cstdint>

#include "core/tracking/pyramid_search.h"
#include "core/tracking/tracker.h"

namespace spidar {

struct FollowedPoint {
  uint32_t id = 0;
  ImagePoint at;     ///< in the base of the pyramid
  ImagePoint frame;  ///< in the frame
  ImagePoint from;   ///< where that was in the frame before
  ImagePoint moved;  ///< since the frame before, in the base; of a new one: expected
  int level = 0;     ///< of the pyramid: where it was chosen and is looked for
  bool is_new = true;
  bool may_shift = true;  ///< nobody was told where it is: a window beside may stand for it

  bool found = false;        ///< in this frame
  bool is_surprise = false;  ///< found where neither its past nor its neighbours led
  bool is_shifted = false;   ///< in this frame, to a window beside the one that was chosen
  bool has_place = false;    ///< on the grid
  PointMatch match;
};

inline ImagePoint operator-(ImagePoint a, ImagePoint b) {
  return {a.x_px - b.x_px, a.y_px - b.y_px};
}

inline ImagePoint operator+(ImagePoint a, ImagePoint b) {
  return {a.x_px + b.x_px, a.y_px + b.y_px};
}

}  // namespace spidar
