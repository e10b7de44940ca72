// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The functions of core/field/block_kernels.h pixel by pixel, as they are defined.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "core/field/block_kernels.h"

namespace spidar::test::plain {

inline int interpolated(const uint8_t* pixel, ptrdiff_t stride, int fraction_x, int fraction_y) {
  const uint8_t* below = pixel + stride;
  const int upper = (kFractionOne - fraction_x) * pixel[0] + fraction_x * pixel[1];
  const int lower = (kFractionOne - fraction_x) * below[0] + fraction_x * below[1];
  return ((kFractionOne - fraction_y) * upper + fraction_y * lower + 128) >> 8;
}

inline int block_difference(BlockPixels a, BlockPixels b, int limit) {
  int sum = 0;
  for (int y = 0; y < kBlock_px; ++y) {
    if (y == kBlock_px / 2 && sum >= limit) return sum;
    for (int x = 0; x < kBlock_px; ++x) {
      sum += std::abs(a.pixels[y * a.stride + x] - b.pixels[y * b.stride + x]);
    }
  }
  return sum;
}

inline int block_difference(BlockPixels a, BlockPixels b, BlockPixels counted) {
  int sum = 0;
  for (int i = 0; i < kBlockArea_px; ++i) {
    const int x = i % kBlock_px, y = i / kBlock_px;
    if (counted.pixels[y * counted.stride + x] == 0) continue;
    sum += std::abs(a.pixels[y * a.stride + x] - b.pixels[y * b.stride + x]);
  }
  return sum;
}

inline int difference_from_mean(BlockPixels block) {
  int sum = kBlockArea_px / 2;
  for (int i = 0; i < kBlockArea_px; ++i) {
    sum += block.pixels[i / kBlock_px * block.stride + i % kBlock_px];
  }
  int difference = 0;
  for (int i = 0; i < kBlockArea_px; ++i) {
    const int grey = block.pixels[i / kBlock_px * block.stride + i % kBlock_px];
    difference += std::abs(grey - sum / kBlockArea_px);
  }
  return difference;
}

inline unsigned steep_pixels(BlockPixels row, int least) {
  unsigned steep = 0;
  for (int x = 0; x < kBlock_px; ++x) {
    const uint8_t* p = row.pixels + x;
    const int across = p[1] - p[-1];
    const int down = p[row.stride] - p[-row.stride];
    if (across * across + down * down >= least) steep |= 1U << x;
  }
  return steep;
}

inline int cell_difference(BlockPixels a, BlockPixels b) {
  int sum = 0;
  for (int cell = 0; cell < kBlockArea_px; cell += kCell_px * kCell_px) {
    const int cells = kBlock_px / kCell_px;
    const int left = cell / (kCell_px * kCell_px) % cells * kCell_px;
    const int top = cell / (kCell_px * kCell_px) / cells * kCell_px;
    int difference = 0;
    for (int i = 0; i < kCell_px * kCell_px; ++i) {
      const int x = left + i % kCell_px;
      const int y = top + i / kCell_px;
      difference += a.pixels[y * a.stride + x] - b.pixels[y * b.stride + x];
    }
    sum += std::abs(difference);
  }
  return sum;
}

inline int bilinear_difference(BlockPixels now, BlockPixels before, int fraction_x,
                               int fraction_y) {
  int sum = 0;
  for (int y = 0; y < kBlock_px; ++y) {
    for (int x = 0; x < kBlock_px; ++x) {
      const uint8_t* p = before.pixels + y * before.stride + x;
      const int value = interpolated(p, before.stride, fraction_x, fraction_y);
      sum += std::abs(value - now.pixels[y * now.stride + x]);
    }
  }
  return sum;
}

inline int twice_slope(const uint8_t* p, ptrdiff_t step) {
  const int near = p[step] - p[-step];
  const int far = p[2 * step] - p[-2 * step];
  return near + static_cast<int>(std::floor((2 * near - far) / 4.0));
}

inline BlockSums compare_blocks(BlockPixels now, BlockPixels before, BlockPixels counted) {
  BlockSums sums;
  sums.pixels = 0;
  for (int y = 0; y < kBlock_px; ++y) {
    for (int x = 0; x < kBlock_px; ++x) {
      if (counted.pixels[y * counted.stride + x] == 0) continue;
      ++sums.pixels;
      const uint8_t* p = now.pixels + y * now.stride + x;
      const uint8_t* q = before.pixels + y * before.stride + x;
      const int gx = twice_slope(p, 1) + twice_slope(q, 1);
      const int gy = twice_slope(p, now.stride) + twice_slope(q, before.stride);
      const int d = p[0] - q[0];
      sums.xx += gx * gx;
      sums.xy += gx * gy;
      sums.yy += gy * gy;
      sums.x += gx;
      sums.y += gy;
      sums.xd += gx * d;
      sums.yd += gy * d;
      sums.difference += d;
      sums.squared += d * d;
    }
  }
  return sums;
}

inline StayingPixels staying_pixels(BlockPixels now, BlockPixels before, const MovedBlock& from,
                                    const MovedBlock& to) {
  const auto moved = [](const MovedBlock& block, int x, int y) {
    return interpolated(block.pixels.pixels + y * block.pixels.stride + x, block.pixels.stride,
                        block.fraction_x, block.fraction_y);
  };
  StayingPixels staying;
  for (int y = 0; y < kBlock_px; ++y) {
    for (int x = 0; x < kBlock_px; ++x) {
      const int is = now.pixels[y * now.stride + x];
      const int was = before.pixels[y * before.stride + x];
      const int changed = std::abs(is - was);
      const int moving =
          std::max(std::abs(is - moved(from, x, y)), std::abs(was - moved(to, x, y)));
      if (changed > kDoubtful_grey || moving - changed < kClear_grey) continue;
      ++staying.near;
      staying.exact += changed == 0;
    }
  }
  return staying;
}

}  // namespace spidar::test::plain
