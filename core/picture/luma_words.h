// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Readers that convert luma of more than 8 bits to 8 bits.
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/picture/image_view.h"
#include "core/picture/opencv.h"

namespace spidar {

struct LumaBytes {
  static constexpr int kBytes = 1;

  explicit LumaBytes(const LumaSample&) {}

  int at(const uint8_t* pixel) const { return *pixel; }
  cv::v_uint8x16 load(const uint8_t* pixels) const { return cv::v_load(pixels); }
};

/// Pixels of one 16-bit word, big or little endian.
template <bool kBigEndian>
struct LumaWords {
  static constexpr int kBytes = 2;

  explicit LumaWords(const LumaSample& sample) : shift(sample.shift) {}

  int at(const uint8_t* pixel) const {
    const int word = kBigEndian ? pixel[0] << 8 | pixel[1] : pixel[1] << 8 | pixel[0];
    return std::min(word >> shift, 255);
  }
  cv::v_uint8x16 load(const uint8_t* pixels) const {
    return cv::v_pack(half(pixels), half(pixels + 16));
  }

  cv::v_uint16x8 half(const uint8_t* pixels) const {
    static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "lanes are read in memory order");
    cv::v_uint16x8 words = cv::v_reinterpret_as_u16(cv::v_load(pixels));
    if constexpr (kBigEndian) words = (words << 8) | (words >> 8);
    return words >> shift;
  }

  int shift;
};

/// Calls `work` with the matching reader, a LumaBytes or a LumaWords.
template <typename Work>
void with_reader(const LumaSample& sample, Work&& work) {
  if (sample.bytes == 1) {
    work(LumaBytes(sample));
  } else if (sample.big_endian) {
    work(LumaWords<true>(sample));
  } else {
    work(LumaWords<false>(sample));
  }
}

}  // namespace spidar
