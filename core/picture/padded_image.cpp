// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/picture/padded_image.h"

#include <algorithm>
#include <cstring>

#include "core/picture/luma.h"
#include "core/picture/luma_words.h"
#include "core/picture/opencv.h"

namespace spidar {
namespace {

using cv::v_int16x8;
using cv::v_int32x4;
using cv::v_uint16x8;
using cv::v_uint8x16;

/// Sums of the 8 pairs of neighbours in 16 pixels.
template <typename Reader>
v_uint16x8 pair_sums(const Reader& reader, const uint8_t* pixels) {
  const v_uint16x8 pairs = cv::v_reinterpret_as_u16(reader.load(pixels));
  return (pairs & cv::v_setall_u16(0xFF)) + (pairs >> 8);
}

/// The same sums over `kRows` rows, `step` bytes apart.
template <int kRows, typename Reader>
v_uint16x8 pair_sums(const Reader& reader, const uint8_t* pixels, ptrdiff_t step) {
  v_uint16x8 sum = pair_sums(reader, pixels);
  for (int k = 1; k < kRows; ++k) sum = sum + pair_sums(reader, pixels + k * step);
  return sum;
}

/// Adds neighbours: 16 values to 8 sums. Values and sums must be below 2¹⁵.
v_uint16x8 add_neighbours(const v_uint16x8& a, const v_uint16x8& b) {
  const v_int16x8 ones = cv::v_setall_s16(1);
  return cv::v_reinterpret_as_u16(cv::v_pack(cv::v_dotprod(cv::v_reinterpret_as_s16(a), ones),
                                             cv::v_dotprod(cv::v_reinterpret_as_s16(b), ones)));
}

/// Sums of 8 blocks of kFactor × kRows pixels.
template <int kFactor, int kRows, typename Reader>
v_uint16x8 block_sums(const Reader& reader, const uint8_t* pixels, ptrdiff_t step) {
  if constexpr (kFactor == 2) {
    return pair_sums<kRows>(reader, pixels, step);
  } else {
    constexpr int kHalf = 4 * kFactor * Reader::kBytes;
    return add_neighbours(block_sums<kFactor / 2, kRows>(reader, pixels, step),
                          block_sums<kFactor / 2, kRows>(reader, pixels + kHalf, step));
  }
}

/// Number of rows of blocks by which pixels are prefetched. Without prefetching, the processor
/// stalls at each row of a frame with skipped rows, and takes three times as long in total.
constexpr int kRowsAhead = 2;

struct SourceRows {
  ptrdiff_t step;  ///< between the rows that are used
  int factor;
  int rows;     ///< number of rows used per block
  int columns;  ///< blocks
  const uint8_t* pixels = nullptr;
  const uint8_t* ahead = nullptr;  ///< the first row to prefetch

  unsigned count() const { return static_cast<unsigned>(rows * factor); }
};

template <typename Reader>
uint8_t block_mean(const Reader& reader, const SourceRows& row, int x) {
  unsigned sum = 0;
  for (int k = 0; k < row.rows; ++k) {
    const uint8_t* pixels = row.pixels + k * row.step + x * row.factor * Reader::kBytes;
    for (int i = 0; i < row.factor; ++i) {
      sum += static_cast<unsigned>(reader.at(pixels + i * Reader::kBytes));
    }
  }
  return static_cast<uint8_t>((sum + row.count() / 2u) / row.count());
}

/// `row` is a copy, because a store might alias anything else.
template <int kFactor, typename Reader>
int reduce_by_power_of_2(const Reader& reader, const SourceRows row, uint8_t* to) {
  constexpr int kCacheLine = 64;
  constexpr int kBlock = kFactor * Reader::kBytes;
  constexpr int kRows = rows_used(kFactor);
  constexpr int kCount = kRows * kFactor;  // a power of 2
  const v_uint16x8 half = cv::v_setall_u16(kCount / 2);
  const v_uint16x8 inverse = cv::v_setall_u16(65536 / kCount);
  int x = 0;
  for (; x + 8 <= row.columns; x += 8) {
    // A cache line that several vectors share is prefetched once.
    const bool begins_line = 8 * kBlock >= kCacheLine || x * kBlock % kCacheLine == 0;
    for (int k = 0; begins_line && k < kRows; ++k) {
      for (int i = 0; i < 8 * kBlock; i += kCacheLine) {
        __builtin_prefetch(row.ahead + k * row.step + x * kBlock + i);
      }
    }
    const v_uint16x8 sums = block_sums<kFactor, kRows>(reader, row.pixels + x * kBlock, row.step);
    cv::v_pack_store(to + x, cv::v_mul_hi(sums + half, inverse));
  }
  return x;
}

/// Returns the number of blocks processed, from the left; the caller processes the rest.
template <typename Reader>
int reduce_with_vectors(const Reader& reader, const SourceRows& row, uint8_t* to) {
  switch (row.factor) {
    case 2:
      return reduce_by_power_of_2<2>(reader, row, to);
    case 4:
      return reduce_by_power_of_2<4>(reader, row, to);
    case 8:
      return reduce_by_power_of_2<8>(reader, row, to);
    case 16:
      return reduce_by_power_of_2<16>(reader, row, to);
    default:
      return 0;
  }
}

}  // namespace

int halving_factor(int width, int height) {
  const double area_px2 = static_cast<double>(width) * height;
  int factor = 1;
  // Rounds on a logarithmic scale: from 3 on, the area is nearer to 2² than to 1.5², by which it
  // can be reduced further.
  while (area_px2 >= 3 * kFieldArea_px2 * factor * factor &&
         std::min(width, height) / (2 * factor) >= kMinSide_px) {
    factor *= 2;
  }
  return factor;
}

void PaddedImage::resize(int width, int height) {
  if (width == width_ && height == height_) return;
  width_ = width;
  height_ = height;
  // Vector loads may read up to 16 bytes beyond the bytes they use.
  stride_ = (width + 2 * kPad_px + 15) / 16 * 16;
  offset_ = kPad_px * stride_ + kPad_px;
  memory_.assign(static_cast<size_t>(stride_) * static_cast<size_t>(height + 2 * kPad_px) + 16, 0);
}

void PaddedImage::repeat_border() {
  const auto left = static_cast<size_t>(kPad_px);
  const auto right = static_cast<size_t>(stride_ - kPad_px - width_);
  for (int y = 0; y < height_; ++y) {
    uint8_t* pixels = row(y);
    std::memset(pixels - kPad_px, pixels[0], left);
    std::memset(pixels + width_, pixels[width_ - 1], right);
  }
  for (int y = 1; y <= kPad_px; ++y) {
    const auto bytes = static_cast<size_t>(stride_);
    std::memcpy(row(-y) - kPad_px, row(0) - kPad_px, bytes);
    std::memcpy(row(height_ - 1 + y) - kPad_px, row(height_ - 1) - kPad_px, bytes);
  }
}

void reduce_blocks(const ImageView& frame, int factor, PaddedImage& reduced) {
  reduced.resize(frame.width / factor, frame.height / factor);
  SourceRows row{row_step(factor) * frame.stride_bytes, factor, rows_used(factor), reduced.width()};
  for (int y = 0; y < reduced.height(); ++y) {
    const int ahead = std::min(y + kRowsAhead, reduced.height() - 1);
    row.pixels = frame.data + y * factor * frame.stride_bytes;
    row.ahead = frame.data + ahead * factor * frame.stride_bytes;
    uint8_t* to = reduced.row(y);
    if (factor == 1) {
      copy_row(frame, 0, y, row.columns, to);
      continue;
    }
    with_reader(frame.sample, [&](const auto& reader) {
      int x = reduce_with_vectors(reader, row, to);
      for (; x < row.columns; ++x) to[x] = block_mean(reader, row, x);
    });
  }
}

void halve(const PaddedImage& image, PaddedImage& half) {
  reduce_blocks(image.view(), 2, half);
}

}  // namespace spidar
