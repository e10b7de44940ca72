// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The arithmetic of following a small window: all that is done once a pixel.
#pragma once

#include <cstddef>
#include <cstdint>

namespace spidar {

// Fixed point, so that vectors and plain code give the same bits: a pixel has 5 bits below the
// point (a 16-bit lane holds 255 with two to spare), a derivative 4, a difference 3.
constexpr int kPixelOne = 32;
constexpr int kDerivativeOne = 16;
constexpr int kDifferenceOne = 8;
/// Of a gain; the largest that a 16-bit lane holds is just below 2.
constexpr int kGainOne = 1 << 14;

/// Shares of the four neighbours in a bilinear interpolation, of 256.
struct BilinearWeights {
  int w00, w01, w10, w11;  ///< upper left, upper right, lower left, lower right

  /// Of a point `fx`, `fy` (0 … 1) to the right of and below a pixel.
  static BilinearWeights at(float fx, float fy) {
    const int x = static_cast<int>(fx * 256 + 0.5f);
    const int y = static_cast<int>(fy * 256 + 0.5f);
    const int w11 = (x * y + 128) >> 8;
    return {256 - x - y + w11, x - w11, y - w11, w11};
  }
};

/// Where a window is read: its upper left pixel and how far beyond that it begins.
struct WindowSource {
  const uint8_t* pixels;
  ptrdiff_t stride;
  BilinearWeights weights;
};

/// Σ over a template of its derivatives' products and of the derivatives, in derivative units.
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

/// Columns and rows that read_template() reads from its source on, whole vectors included.
constexpr int template_columns(int side) {
  return side + 9;
}
constexpr int template_rows(int side) {
  return side + 3;
}

namespace vectors {
/// Reads a template whose upper left pixel is one right of and below `from`: derivatives are
/// central differences.
template <int kSide>
TemplateSums read_template(const WindowSource& from, TemplatePixels<kSide>& to);

/// Compares a window with a template. Reads kSide + 1 rows and columns. `gain` of kGainOne: what
/// the template's contrast is multiplied by.
template <int kSide>
DifferenceSums compare(const WindowSource& window, const TemplatePixels<kSide>& with, int gain);

/// Σ |a − b| over 8 × 8 pixels.
int absolute_difference(const uint8_t* a, ptrdiff_t stride_a, const uint8_t* b, ptrdiff_t stride_b);
}  // namespace vectors

/// The same by their definition.
namespace plain {
template <int kSide>
TemplateSums read_template(const WindowSource& from, TemplatePixels<kSide>& to);
template <int kSide>
DifferenceSums compare(const WindowSource& window, const TemplatePixels<kSide>& with, int gain);
int absolute_difference(const uint8_t* a, ptrdiff_t stride_a, const uint8_t* b, ptrdiff_t stride_b);
}  // namespace plain

}  // namespace spidar
