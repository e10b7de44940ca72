// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Brightness of all places of a picture at which a block may have been.
#pragma once

#include <cstdint>
#include <vector>

#include "core/tracking/padded_image.h"

namespace spidar {

/// Σ of the pixels of each area of the size of a block. Two blocks differ by at least as much as
/// their sums do (successive elimination: Li and Salari, 1995), so that most places of a search
/// need not be looked at.
class AreaSums {
 public:
  /// For pictures of this size. Keeps the memory when the size is the same.
  void resize(int width, int height);
  /// Sums the areas of a block's size that lie at most kBlockReach_px beyond the edge.
  void read(const PaddedImage& picture);

  /// The sum of the area whose first pixel is `right_px`, `down_px` from the first one of all.
  int at(int right_px, int down_px) const {
    return sums_[static_cast<size_t>(down_px) * width_ + static_cast<size_t>(right_px)];
  }

 private:
  size_t width_ = 0;              ///< px that are read of a row
  std::vector<uint16_t> column_;  ///< Σ of the rows of an area
  std::vector<uint16_t> sums_;    ///< at most 16 · 16 · 255 < 2¹⁶
};

}  // namespace spidar
