// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Access to the pixels of a frame around one point.
#pragma once

#include <array>
#include <cstdint>

#include "core/image_view.h"
#include "core/tracking/tracker.h"
#include "core/tracking/window_match.h"

namespace spidar {

/// Provides the pixels for a window of up to kWindow_px around a point: those of the frame itself
/// if it has 8 bits, otherwise a converted copy.
class LumaNeighbourhood {
 public:
  static constexpr int kWindow_px = 24;
  static constexpr float kMostReach_px = 8.5f;

  /// Returns all pixels, within the frame, that WindowTemplate::read() needs at `centre` and find()
  /// needs with a reach of `reach_px` ≤ kMostReach_px. Valid until the next call.
  ReadablePixels around(const ImageView& frame, ImagePoint centre, float reach_px);

 private:
  // Distances from the pixel that contains the centre. A template begins half its side and one
  // pixel before the centre, so these bounds hold for every sub-pixel position of the centre.
  static constexpr int kBefore_px = kWindow_px / 2 + 1;
  static constexpr int kRight_px = template_columns(kWindow_px) - kBefore_px + 2;
  static constexpr int kBelow_px = template_rows(kWindow_px) - kBefore_px + 2;
  static constexpr int kMostWhole_px = 9;  ///< kMostReach_px in whole pixels
  static constexpr int kWidest_px = kBefore_px + kRight_px + 2 * kMostWhole_px;
  static constexpr int kHighest_px = kBefore_px + kBelow_px + 2 * kMostWhole_px;

  std::array<uint8_t, kWidest_px * kHighest_px> pixels_;
};

}  // namespace spidar
