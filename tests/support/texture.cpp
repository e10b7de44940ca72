// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/support/texture.h"

#include <array>
#include <cmath>
#include <cstdint>

namespace spidar::test {
namespace {

/// −1 … 1, the same for the same arguments on every machine.
double lattice_value(uint32_t seed, int64_t i, int64_t j) {
  uint64_t h = seed * 0x9E3779B97F4A7C15u;
  for (const int64_t part : {i, j}) {
    // SplitMix64 (Steele, Lea, Flood: Fast splittable pseudorandom number generators, 2014).
    h += static_cast<uint64_t>(part) + 0x9E3779B97F4A7C15u;
    h = (h ^ (h >> 30)) * 0xBF58476D1CE4E5B9u;
    h = (h ^ (h >> 27)) * 0x94D049BB133111EBu;
    h ^= h >> 31;
  }
  return static_cast<double>(h >> 11) * 0x1p-52 - 1;
}

/// Weights of a cubic B-spline's four nearest grid points for a position t = 0 … 1 between the two
/// in the middle.
std::array<double, 4> bspline_weights(double t) {
  const double s = 1 - t;
  return {s * s * s / 6, (3 * t * t * t - 6 * t * t + 4) / 6, (3 * s * s * s - 6 * s * s + 4) / 6,
          t * t * t / 6};
}

}  // namespace

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
