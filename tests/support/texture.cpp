// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/support/texture.h"

#include <array>
#include <cmath>

#include "tests/support/bspline.h"

namespace spidar::test {

double Texture::at(double x_px, double y_px) const {
  constexpr double kMean = 128;
  constexpr double kAmplitude = 120;  // a mean of values of at most 1 stays inside
  const double u = x_px / cell_px_;
  const double v = y_px / cell_px_;
  const auto i = static_cast<int64_t>(std::floor(u));
  const auto j = static_cast<int64_t>(std::floor(v));
  const std::array<double, 4> wx = bspline_weights(u - std::floor(u));
  const std::array<double, 4> wy = bspline_weights(v - std::floor(v));
  double sum = 0;
  for (size_t b = 0; b < 4; ++b) {
    double row = 0;
    for (size_t a = 0; a < 4; ++a) {
      row += wx[a] *
             lattice_value(seed_, i + static_cast<int64_t>(a) - 1, j + static_cast<int64_t>(b) - 1);
    }
    sum += wy[b] * row;
  }
  return kMean + kAmplitude * sum;
}

}  // namespace spidar::test
