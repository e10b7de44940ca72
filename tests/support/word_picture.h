// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "core/picture/image_view.h"
#include "tests/support/picture.h"

namespace spidar::test {

/// Ways in which video formats store 10, 12 and 16 bits of luma.
inline const std::vector<LumaSample> kWordSamples{{2, 2, false}, {2, 2, true},  {2, 4, false},
                                                  {2, 4, true},  {2, 8, false}, {2, 8, true}};

inline std::string name_of(const LumaSample& sample) {
  return "shift " + std::to_string(sample.shift) +
         (sample.big_endian ? ", big endian" : ", little endian");
}

/// `picture` in words of more than 8 bits, with noise in the lower bits. Rows begin at odd
/// addresses.
class WordPicture {
 public:
  WordPicture(const Picture& picture, const LumaSample& sample, uint32_t seed = 1)
      : width_(picture.width), height_(picture.height), sample_(sample) {
    std::mt19937 random(seed);
    bytes_.push_back(0xAA);
    for (int y = 0; y < height_; ++y) {
      for (int x = 0; x < width_; ++x) {
        const auto noise = static_cast<uint32_t>(random()) & ((1u << sample.shift) - 1);
        const uint32_t word = uint32_t{picture.view().at(x, y)[0]} << sample.shift | noise;
        const auto low = static_cast<uint8_t>(word);
        const auto high = static_cast<uint8_t>(word >> 8);
        bytes_.push_back(sample.big_endian ? high : low);
        bytes_.push_back(sample.big_endian ? low : high);
      }
      for (int i = 0; i < kPadding; ++i) bytes_.push_back(0xAA);
    }
  }

  ImageView view() const {
    return {bytes_.data() + 1, width_, height_, 2 * ptrdiff_t{width_} + kPadding, sample_};
  }

 private:
  static constexpr int kPadding = 6;
  int width_;
  int height_;
  LumaSample sample_;
  std::vector<uint8_t> bytes_;
};

}  // namespace spidar::test
