// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The last fraction of a pixel, found in the frame itself.
#pragma once

#include "core/image_view.h"
#include "core/tracking/luma_neighbourhood.h"
#include "core/tracking/tracker.h"
#include "core/tracking/window_match.h"

namespace spidar {

/// What a point was found to be in the reduced picture.
struct CoarsePlace {
  ImagePoint at;           ///< px of the frame
  float variance_px2 = 0;  ///< px of the reduced picture
  float strength = 0;      ///< of the window in the reduced picture, (grey / px)²
  float gain = 1;          ///< of the light, see MatchSettings
};

/// What the surroundings of a point looked like in the frame before. The frame itself is not kept.
class FineWindow {
 public:
  void read(LumaNeighbourhood& neighbourhood, const ImageView& frame, ImagePoint at) {
    window_.read(neighbourhood.around(frame, at, 0), at);
  }

  /// The place in the frame, from that in a picture reduced by `factor`: the mean of both, each
  /// weighted by the inverse of its variance, where the frame's own structure is worth it; else the
  /// coarse one.
  ImagePoint place(LumaNeighbourhood& neighbourhood, const ImageView& frame, int factor,
                   const CoarsePlace& coarse) const;

  /// What passes for the same thing has a residual below this, see WindowMatch.
  static constexpr float kSameThing = 0.5f;

 private:
  WindowTemplate<LumaNeighbourhood::kWindow_px> window_;
};

}  // namespace spidar
