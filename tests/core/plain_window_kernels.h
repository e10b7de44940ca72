// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The functions of core/tracking/window_kernels.h, and reduce_blocks() for pixels of one byte,
/// pixel by pixel, as they are defined.
#pragma once

#include <cstdint>

#include "core/tracking/padded_image.h"
#include "core/tracking/window_kernels.h"

namespace spidar::test::plain {

/// Interpolated pixel in pixel units, `x`, `y` whole pixels from the source.
inline int interpolated(const WindowSource& from, int x, int y) {
  const uint8_t* p = from.pixels + y * from.stride + x;
  const uint8_t* q = p + from.stride;
  const BilinearWeights& w = from.weights;
  return (w.w00 * p[0] + w.w01 * p[1] + w.w10 * q[0] + w.w11 * q[1] + 4) >> 3;
}

inline int derivative(int after, int before) {
  return (after - before + 2) >> 2;
}

inline int difference_units(int pixel) {
  return (pixel + 2) >> 2;
}

template <int kSide>
TemplateSums read_template(const WindowSource& from, TemplatePixels<kSide>& to) {
  TemplateSums sums;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const auto at = [&](int i, int j) { return interpolated(from, 1 + x + i, 1 + y + j); };
      const int pixel = at(0, 0);
      const int dx = derivative(at(1, 0), at(-1, 0));
      const int dy = derivative(at(0, 1), at(0, -1));
      to.pixel[y * kSide + x] = static_cast<int16_t>(pixel);
      to.dx[y * kSide + x] = static_cast<int16_t>(dx);
      to.dy[y * kSide + x] = static_cast<int16_t>(dy);
      sums.xx += dx * dx;
      sums.xy += dx * dy;
      sums.yy += dy * dy;
      sums.x += dx;
      sums.y += dy;
      sums.pixel += difference_units(pixel);
      sums.pixel_squared += difference_units(pixel) * difference_units(pixel);
    }
  }
  return sums;
}

template <int kSide>
DifferenceSums compare(const WindowSource& window, const TemplatePixels<kSide>& with, int gain) {
  DifferenceSums sums;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const int k = y * kSide + x;
      const int now = interpolated(window, x, y);
      const int expected = (with.pixel[k] * 4 * gain) >> 16;
      const int d = difference_units(now - expected);
      sums.x += d * with.dx[k];
      sums.y += d * with.dy[k];
      sums.difference += d;
      sums.squared += d * d;
      sums.pixel += difference_units(now);
      sums.pixel_squared += difference_units(now) * difference_units(now);
    }
  }
  return sums;
}

/// Mean of the pixels of each block that are used, rounded.
inline void reduce_blocks(const ImageView& frame, int factor, PaddedImage& reduced) {
  reduced.resize(frame.width / factor, frame.height / factor);
  for (int y = 0; y < reduced.height(); ++y) {
    for (int x = 0; x < reduced.width(); ++x) {
      int sum = 0;
      int count = 0;
      for (int j = 0; j < factor; j += row_step(factor)) {
        for (int i = 0; i < factor; ++i) {
          sum += *frame.at(x * factor + i, y * factor + j);
          ++count;
        }
      }
      reduced.row(y)[x] = static_cast<uint8_t>((sum + count / 2) / count);
    }
  }
}

}  // namespace spidar::test::plain
