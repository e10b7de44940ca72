// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstdint>

namespace spidar::test {

/// A smooth random grey texture, also between the pixels: a cubic B-spline over random values on a
/// grid of `cell_px`. It is twice differentiable, does not repeat, has many corners, and can be
/// evaluated exactly at any position, so a picture of it can be moved by any fraction of a pixel
/// without resampling.
class Texture {
 public:
  /// `cell_px` > 0 is the distance of the grid points; structures are about twice as large.
  Texture(uint32_t seed, double cell_px) : seed_(seed), cell_px_(cell_px) {}

  /// Grey level at a position, 8 … 248.
  double at(double x_px, double y_px) const;

 private:
  uint32_t seed_;
  double cell_px_;
};

}  // namespace spidar::test
