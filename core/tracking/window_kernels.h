// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The per-pixel arithmetic of tracking a small window.
#pragma once

#include <cstddef>
#include <cstdint>

namespace spidar {

// Fixed point, so that vector and plain code give identical results. A pixel has 5 fractional bits
// (a 16-bit lane holds 255 with two bits to spare), a derivative 4, a difference 3.
constexpr int kPixelOne = 32;
constexpr int kDerivativeOne = 16;
constexpr int kDifferenceOne = 8;
/// Unit of a gain; the largest gain that fits into a 16-bit lane is just below 2.
constexpr int kGainOne = 1 << 14;

/// Weights of the four neighbours in a bilinear interpolation, in 1/256.
struct BilinearWeights {
  int w00, w01, w10, w11;  ///< upper left, upper right, lower left, lower right

  /// Weights for a point `fx`, `fy` (0 … 1) to the right of and below a pixel.
  static BilinearWeights at(float fx, float fy) {
    const int x = static_cast<int>(fx * 256 + 0.5f);
    const int y = static_cast<int>(fy * 256 + 0.5f);
    const int w11 = (x * y + 128) >> 8;
    return {256 - x - y + w11, x - w11, y - w11, w11};
  }
};

/// Source of a window: its upper left pixel and the sub-pixel offset from it.
struct WindowSource {
  const uint8_t* pixels;
  ptrdiff_t stride;
  BilinearWeights weights;
};

/// Sums over a template: products of its derivatives and the derivatives, in derivative units.
struct TemplateSums {
  int64_t xx = 0;
  int64_t xy = 0;
  int64_t yy = 0;
  int64_t x = 0;
  int64_t y = 0;
  int64_t pixel = 0;          ///< Σ of the pixels in difference units
  int64_t pixel_squared = 0;  ///< and of their squares

  bool operator==(const TemplateSums& o) const {
    return xx == o.xx && xy == o.xy && yy == o.yy && x == o.x && y == o.y && pixel == o.pixel &&
           pixel_squared == o.pixel_squared;
  }
};

/// Σ over a window of d = now − gain · template, in difference units, and its products.
struct DifferenceSums {
  int64_t x = 0;              ///< Σ d · ∂/∂x
  int64_t y = 0;              ///< Σ d · ∂/∂y
  int64_t difference = 0;     ///< Σ d
  int64_t squared = 0;        ///< Σ d²
  int64_t pixel = 0;          ///< Σ of the pixels of now, in difference units
  int64_t pixel_squared = 0;  ///< and of their squares

  bool operator==(const DifferenceSums& o) const {
    return x == o.x && y == o.y && difference == o.difference && squared == o.squared &&
           pixel == o.pixel && pixel_squared == o.pixel_squared;
  }
};

/// Template of kSide × kSide pixels with its derivatives.
template <int kSide>
struct TemplatePixels {
  static_assert(kSide % 8 == 0, "rows are whole vectors");
  alignas(16) int16_t pixel[kSide * kSide];  ///< pixel units
  alignas(16) int16_t dx[kSide * kSide];     ///< derivative units
  alignas(16) int16_t dy[kSide * kSide];
};

/// Number of columns and rows that read_template() reads from its source, including whole vectors.
constexpr int template_columns(int side) {
  return side + 9;
}
constexpr int template_rows(int side) {
  return side + 3;
}

/// Reads a template whose upper left pixel is one pixel right of and below `from`. Derivatives are
/// central differences.
template <int kSide>
TemplateSums read_template(const WindowSource& from, TemplatePixels<kSide>& to);

/// Compares a window with a template. Reads kSide + 1 rows and columns. `gain`, in units of
/// 1/kGainOne, multiplies the contrast of the template.
template <int kSide>
DifferenceSums compare(const WindowSource& window, const TemplatePixels<kSide>& with, int gain);

}  // namespace spidar
