// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Random values on a grid, and the smooth surface through them.
#pragma once

#include <array>
#include <cstdint>

namespace spidar::test {

/// −1 … 1, the same for the same arguments on every machine.
inline double lattice_value(uint32_t seed, int64_t i, int64_t j) {
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
template <typename Real>
std::array<Real, 4> bspline_weights(Real t) {
  const Real s = 1 - t;
  return {s * s * s / 6, (3 * t * t * t - 6 * t * t + 4) / 6, (3 * s * s * s - 6 * s * s + 4) / 6,
          t * t * t / 6};
}

}  // namespace spidar::test
