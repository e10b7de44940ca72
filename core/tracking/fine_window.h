// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Sub-pixel refinement of a point in the full-resolution frame.
#pragma once

#include "core/image_view.h"
#include "core/tracking/luma_neighbourhood.h"
#include "core/tracking/tracker.h"
#include "core/tracking/window_match.h"

namespace spidar {

/// Side of the window in which a point is searched in the reduced picture.
constexpr int kPointWindow_px = 16;

/// Result of the search for a point in the reduced picture.
struct CoarsePlace {
  ImagePoint at;           ///< px of the frame
  float variance_px2 = 0;  ///< px of the reduced picture
  float strength = 0;      ///< of the window in the reduced picture, (grey / px)²
};

/// Templates of a point's surroundings from the previous frame, which itself is not kept.
class FineWindow {
 public:
  void read(LumaNeighbourhood& neighbourhood, const ImageView& frame, ImagePoint at) {
    window_.read(neighbourhood.around(frame, at, 0), at);
  }

  /// Returns the refined position in the frame, given the position in a picture reduced by
  /// `factor`. If the frame has enough structure, this is the mean of both positions, weighted by
  /// their inverse variances; otherwise it is the coarse position.
  ImagePoint place(LumaNeighbourhood& neighbourhood, const ImageView& frame, int factor,
                   const CoarsePlace& coarse) const;

 private:
  WindowTemplate<LumaNeighbourhood::kWindow_px> window_;
};

}  // namespace spidar
