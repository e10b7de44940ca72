// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A picture with padding for windows beyond its edge, and the reductions that produce one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/picture/image_view.h"

namespace spidar {

/// An 8-bit picture whose border pixels are replicated for kPad_px on each side, so that windows
/// may cross the edge without a check.
class PaddedImage {
 public:
  static constexpr int kPad_px = 32;

  /// Keeps the memory when the size is the same.
  void resize(int width, int height);
  /// Call this after the pixels have been written.
  void repeat_border();

  int width() const { return width_; }
  int height() const { return height_; }
  ptrdiff_t stride() const { return stride_; }
  uint8_t* row(int y) { return memory_.data() + offset_ + y * stride_; }
  const uint8_t* row(int y) const { return memory_.data() + offset_ + y * stride_; }
  ImageView view() const { return {row(0), width_, height_, stride_}; }

 private:
  int width_ = 0;
  int height_ = 0;
  ptrdiff_t stride_ = 0;
  ptrdiff_t offset_ = 0;  ///< of the pixel (0, 0)
  std::vector<uint8_t> memory_;
};

/// The area of a reduced picture, as nearly as reductions by powers of 2 and 3/2 allow.
constexpr double kFieldArea_px2 = 427.0 * 240.0;

/// The largest power of 2 that leaves at least a picture of nearly kFieldArea_px2. It is smaller if
/// the shorter side would otherwise fall below kMinSide_px.
int halving_factor(int width, int height);

/// Row step within a block of `factor` rows for reduce_blocks(): every row up to 3, every second
/// row from 4 on. This halves the memory traffic without a noticeable loss in tracking.
constexpr int row_step(int factor) {
  return factor >= 4 ? 2 : 1;
}
constexpr int rows_used(int factor) {
  return (factor + row_step(factor) - 1) / row_step(factor);
}

/// Sets `reduced` (8 bits) to the rounded mean of each block of `factor` × `factor` pixels, using
/// the rows of a block that row_step() selects. Incomplete blocks at the right and bottom are left
/// out. Powers of 2 up to 16 are fast.
void reduce_blocks(const ImageView& frame, int factor, PaddedImage& reduced);

/// Mean of each 2 × 2 block, rounded.
void halve(const PaddedImage& image, PaddedImage& half);

}  // namespace spidar
