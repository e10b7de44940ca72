// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/tracking/fine_window.h"

namespace spidar {

ImagePoint FineWindow::place(LumaNeighbourhood& neighbourhood, const ImageView& frame, int factor,
                             const CoarsePlace& coarse) const {
  const auto scale = static_cast<float>(factor);
  // Refinement in the frame pays off if it tells at least as much about the place, which strength
  // times pixels does.
  constexpr float kPixels = LumaNeighbourhood::kWindow_px * LumaNeighbourhood::kWindow_px;
  constexpr float kCoarsePixels = kPointWindow_px * kPointWindow_px;
  const float strength = scale * scale * window_.strength();
  if (kPixels * strength < kCoarsePixels * coarse.strength) return coarse.at;
  MatchSettings settings;
  settings.iterations = 3;
  settings.step_px = 0.03f;
  settings.reach_px = 0.5f + 0.5f * scale;
  WindowMatch match;
  match.centre = coarse.at;
  const ReadablePixels pixels = neighbourhood.around(frame, coarse.at, settings.reach_px);
  if (!window_.find(pixels, settings, match) || !match.is_same_thing()) return coarse.at;
  const float coarse_px2 = scale * scale * coarse.variance_px2;
  const float both_px2 = coarse_px2 + match.variance_px2;
  const float share = both_px2 > 0 ? coarse_px2 / both_px2 : 1;
  return {coarse.at.x_px + share * (match.centre.x_px - coarse.at.x_px),
          coarse.at.y_px + share * (match.centre.y_px - coarse.at.y_px)};
}

}  // namespace spidar
