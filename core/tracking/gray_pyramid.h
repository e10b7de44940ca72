// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A small copy of the picture at several scales.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/image_view.h"

namespace spidar {

/// 8-bit picture whose border pixels go on for kPad_px on each side, so that a window may reach
/// over the edge without being asked.
class PaddedImage {
 public:
  static constexpr int kPad_px = 32;

  /// Keeps the memory when the size is the same.
  void resize(int width, int height);
  /// Call after the pixels have been written.
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

/// Power of 2 that makes the longer side of a picture about 480 px (340 … 680), or smaller, so that
/// the shorter one keeps kMinSide_px.
int halving_factor(int width, int height);

/// Rows of a block of `factor` rows that reduce_rows() looks at: all of them up to 3, every second
/// from 4 on, which halves what is fetched from memory at no loss that tracking would notice.
constexpr int row_step(int factor) {
  return factor >= 4 ? 2 : 1;
}
constexpr int rows_used(int factor) {
  return (factor + row_step(factor) - 1) / row_step(factor);
}

/// `reduced`, always of 8 bits, becomes the mean of each block of `factor` × `factor` pixels,
/// rounded; of the rows of a block row_step() says which count. Columns and rows that do not fill a
/// block are left out. Powers of 2 up to 16 are fast.
void reduce_blocks(const ImageView& frame, int factor, PaddedImage& reduced);

/// Mean of each 2 × 2 block, rounded.
void halve(const PaddedImage& image, PaddedImage& half);

/// The picture that points are followed in and three times its half: 8 px of the last one are 64.
struct GrayPyramid {
  static constexpr int kLevels = 4;
  std::array<PaddedImage, kLevels> levels;

  /// Of a picture that is already in levels[0], whose border is not.
  void build_from_base();
};

/// The same, pixel by pixel as defined: what the fast versions are compared with.
namespace plain {
void reduce_blocks(const ImageView& frame, int factor, PaddedImage& reduced);
void halve(const PaddedImage& image, PaddedImage& half);
}  // namespace plain

}  // namespace spidar
