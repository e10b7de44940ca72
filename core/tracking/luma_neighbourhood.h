// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A piece of a frame around one point.
#pragma once

#include <array>
#include <cstdint>

#include "core/image_view.h"
#include "core/tracking/tracker.h"
#include "core/tracking/window_match.h"

namespace spidar {

/// Where a window of up to kWindow_px around a point is read: in the frame itself when that has 8
/// bits, else in a copy of the piece.
class LumaNeighbourhood {
 public:
  static constexpr int kWindow_px = 24;
  static constexpr float kMostReach_px = 8.5f;

  /// All that WindowTemplate::read() at `centre` reads, and find() with a reach of `reach_px`, not
  /// more than kMostReach_px, as far as the frame goes. Valid until the next call.
  ReadablePixels around(const ImageView& frame, ImagePoint centre, float reach_px);

 private:
  // From the pixel that the centre lies in. A template begins half its side and a pixel before the
  // centre, so within these two bounds wherever in the pixel the centre is.
  static constexpr int kBefore_px = kWindow_px / 2 + 1;
  static constexpr int kRight_px = template_columns(kWindow_px) - kBefore_px + 2;
  static constexpr int kBelow_px = template_rows(kWindow_px) - kBefore_px + 2;
  static constexpr int kMostWhole_px = 9;  ///< kMostReach_px in whole pixels
  static constexpr int kWidest_px = kBefore_px + kRight_px + 2 * kMostWhole_px;
  static constexpr int kHighest_px = kBefore_px + kBelow_px + 2 * kMostWhole_px;

  std::array<uint8_t, kWidest_px * kHighest_px> pixels_;
};

}  // namespace spidar
