// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/tracking/luma_neighbourhood.h"

#include <algorithm>
#include <cmath>

#include "core/tracking/luma_row.h"

namespace spidar {

ReadablePixels LumaNeighbourhood::around(const ImageView& frame, ImagePoint centre,
                                         float reach_px) {
  if (frame.sample.bytes == 1) return ReadablePixels(frame);
  ReadablePixels found{pixels_.data(), kWidest_px, 0, 0, 0, 0};
  // Treats NaN as outside, before the conversion to an integer.
  const bool inside = centre.x_px >= 0 && centre.x_px <= static_cast<float>(frame.width) &&
                      centre.y_px >= 0 && centre.y_px <= static_cast<float>(frame.height);
  if (!inside) return found;
  const int reach = static_cast<int>(std::ceil(std::min(reach_px, kMostReach_px)));
  const int x = static_cast<int>(centre.x_px);
  const int y = static_cast<int>(centre.y_px);
  found.x0 = std::max(x - kBefore_px - reach, 0);
  found.y0 = std::max(y - kBefore_px - reach, 0);
  found.x1 = std::min(x + kRight_px + reach, frame.width);
  found.y1 = std::min(y + kBelow_px + reach, frame.height);
  for (int row = found.y0; row < found.y1; ++row) {
    copy_row(frame, found.x0, row, found.x1 - found.x0,
             pixels_.data() + (row - found.y0) * kWidest_px);
  }
  return found;
}

}  // namespace spidar
