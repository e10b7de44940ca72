// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <cstdlib>

#include "core/tracking/window_kernels.h"

namespace spidar::plain {
namespace {

/// Interpolated pixel in pixel units, `x`, `y` whole pixels from the source.
int interpolated(const WindowSource& from, int x, int y) {
  const uint8_t* p = from.pixels + y * from.stride + x;
  const uint8_t* q = p + from.stride;
  const BilinearWeights& w = from.weights;
  return (w.w00 * p[0] + w.w01 * p[1] + w.w10 * q[0] + w.w11 * q[1] + 4) >> 3;
}

int derivative(int after, int before) {
  return (after - before + 2) >> 2;
}

int difference_units(int pixel) {
  return (pixel + 2) >> 2;
}

}  // namespace

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

template TemplateSums read_template(const WindowSource&, TemplatePixels<16>&);
template TemplateSums read_template(const WindowSource&, TemplatePixels<24>&);
template DifferenceSums compare(const WindowSource&, const TemplatePixels<16>&, int);
template DifferenceSums compare(const WindowSource&, const TemplatePixels<24>&, int);

}  // namespace spidar::plain
