// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/field/area_sums.h"

#include <algorithm>

#include "core/field/block_kernels.h"
#include "core/field/block_search.h"

namespace spidar {

void AreaSums::resize(int width, int height) {
  width_ = static_cast<size_t>(width + 2 * kBlockReach_px);
  column_.resize(width_);
  sums_.resize(width_ * static_cast<size_t>(height + 2 * kBlockReach_px - kBlock_px + 1));
}

void AreaSums::read(const PaddedImage& picture) {
  const int first = -kBlockReach_px;
  const int last = picture.height() + kBlockReach_px - kBlock_px;
  std::fill(column_.begin(), column_.end(), uint16_t{0});
  const auto row = [&](int y) { return picture.row(y) - kBlockReach_px; };
  for (int y = first; y < first + kBlock_px - 1; ++y) {
    for (size_t x = 0; x < width_; ++x) column_[x] = static_cast<uint16_t>(column_[x] + row(y)[x]);
  }
  for (int y = first; y <= last; ++y) {
    const uint8_t* const below = row(y + kBlock_px - 1);
    for (size_t x = 0; x < width_; ++x) column_[x] = static_cast<uint16_t>(column_[x] + below[x]);
    uint16_t* const sums = sums_.data() + static_cast<size_t>(y - first) * width_;
    std::copy(column_.begin(), column_.end(), sums);
    // Sums two columns, then four, eight and sixteen; nothing asks for those that do not fit in.
    for (size_t n = 1; n < kBlock_px; n *= 2) {
      for (size_t x = 0; x + n < width_; ++x)
        sums[x] = static_cast<uint16_t>(sums[x] + sums[x + n]);
    }
    const uint8_t* const above = row(y);
    for (size_t x = 0; x < width_; ++x) column_[x] = static_cast<uint16_t>(column_[x] - above[x]);
  }
}

}  // namespace spidar
