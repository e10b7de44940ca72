// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A view of a grey picture in memory that the caller owns.
#pragma once

#include <cstddef>
#include <cstdint>

namespace spidar {

/// How a pixel's luma is stored: in one byte, or in a word of two. Of a word only the eight bits
/// above `shift` count; a word with bits above those stands for white.
struct LumaSample {
  int bytes = 1;  ///< 1 or 2; a word need not lie at an even address
  int shift = 0;  ///< of words, 0 … 8: 2 for 10 bits at the lower end, 8 for any at the upper
  bool big_endian = false;  ///< of words
};

/// Luma, `height` rows of `width` pixels, rows `stride_bytes` apart. Never owns the memory.
struct ImageView {
  const uint8_t* data = nullptr;
  int width = 0;
  int height = 0;
  ptrdiff_t stride_bytes = 0;
  LumaSample sample = {};

  const uint8_t* at(int x, int y) const { return data + y * stride_bytes + x * sample.bytes; }
};

/// Height of the reference frame. Lengths in settings are pixels of a frame with 480 lines, so that
/// a setting has the same effect at 360p and at 2160p.
constexpr double kReferenceHeight_px = 480.0;

/// Minimum width and height of a frame in which motion is found, px.
constexpr int kMinSide_px = 16;

/// Throws std::invalid_argument when the frame has no pixels, less than kMinSide_px a side, a
/// stride below its width, or a sample format that LumaSample does not support.
void require_usable(const ImageView& frame);

}  // namespace spidar
