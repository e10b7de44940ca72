// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A point followed by the patch tracker.
#pragma once

#include <cstdint>

#include "core/tracking/pyramid_search.h"
#include "core/tracking/tracker.h"

namespace spidar {

struct FollowedPoint {
  uint32_t id = 0;
  ImagePoint at;     ///< position in the base of the pyramid
  ImagePoint frame;  ///< position in the frame
  ImagePoint from;   ///< `frame` in the previous frame
  ImagePoint moved;  ///< displacement since the previous frame, in the base; expected if new
  int level = 0;     ///< pyramid level at which it was chosen and is searched
  bool is_new = true;
  bool may_shift = true;  ///< not reported yet, so an adjacent window may replace it

  bool found = false;        ///< in this frame
  bool is_surprise = false;  ///< found where neither its history nor its neighbours predicted
  bool is_shifted = false;   ///< replaced in this frame by an adjacent window
  bool has_place = false;    ///< has a cell of the grid
  PointMatch match;
};

inline ImagePoint operator-(ImagePoint a, ImagePoint b) {
  return {a.x_px - b.x_px, a.y_px - b.y_px};
}

inline ImagePoint operator+(ImagePoint a, ImagePoint b) {
  return {a.x_px + b.x_px, a.y_px + b.y_px};
}

}  // namespace spidar
