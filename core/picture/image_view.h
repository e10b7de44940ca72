// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>

namespace spidar {

/// How a pixel's luma is stored: in one byte, or in a word of two bytes. Only the eight bits of a
/// word above the lowest `shift` count; a word with higher bits set stands for white.
struct LumaSample {
  int bytes = 1;  ///< 1 or 2; a word may lie at an odd address
  int shift = 0;  ///< of words, 0 … 8: 2 for 10 low-aligned bits, 8 for any high-aligned ones
  bool big_endian = false;  ///< of words
};

/// A view of a grey picture in memory that the caller owns: luma, `height` rows of `width` pixels,
/// rows `stride_bytes` apart.
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

/// The minimum width and height of a frame in which motion is found, px.
constexpr int kMinSide_px = 16;

/// Throws std::invalid_argument when the frame has no pixels, a side shorter than kMinSide_px, a
/// stride shorter than a row, or a sample format that LumaSample does not support.
inline void require_usable(const ImageView& frame) {
  const LumaSample& sample = frame.sample;
  const bool known =
      (sample.bytes == 1 || sample.bytes == 2) && sample.shift >= 0 && sample.shift <= 8;
  if (!known) {
    throw std::invalid_argument(
        "a pixel of luma has 1 or 2 bytes and a shift of 0 to 8 bits; got " +
        std::to_string(sample.bytes) + " and " + std::to_string(sample.shift));
  }
  if (frame.data && frame.width >= kMinSide_px && frame.height >= kMinSide_px &&
      frame.stride_bytes >= ptrdiff_t{frame.width} * sample.bytes) {
    return;
  }
  throw std::invalid_argument(
      "a frame needs data, at least " + std::to_string(kMinSide_px) + "x" +
      std::to_string(kMinSide_px) + " pixels and a stride of at least a row's bytes; got " +
      (frame.data ? "" : "no data, ") + std::to_string(frame.width) + "x" +
      std::to_string(frame.height) + " with stride " + std::to_string(frame.stride_bytes));
}

}  // namespace spidar
