// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/motion/learned/feature_scales.h"

#include <cmath>
#include <cstdint>
#include <cstring>

#include "core/motion/learned/block_features.h"
#include "core/motion/learned/wide.h"

namespace spidar {
namespace {

/// x becomes ± ln(1 + |x| / unit) / divisor.
struct Scale {
  float unit = 0;  ///< 0: x stays as it is
  float divisor = 1;
};
constexpr Scale kAsItIs{};
constexpr Scale kRelative_px{0.25f, 3};
constexpr Scale kMotion_px{0.25f, 4};
constexpr Scale kDistance{1, 3};
constexpr Scale kShort{1, 2};
constexpr Scale kSquared{1, 6};
constexpr Scale kBetter_grey{0.5f, 4};

constexpr Scale kScales[kFeatures] = {
    // 0: motion relative to the background, its own, and the background's
    kRelative_px, kRelative_px, kMotion_px, kMotion_px, kMotion_px, kMotion_px,
    // 6: distances from the background, from the scene with its depth, and from rest
    kDistance, kDistance, kSquared,
    // 9: texture, its direction, and what the block's motion leaves unexplained
    kSquared, Scale{1, 8}, kAsItIs, kAsItIs, kSquared, kAsItIs,
    // 15: what its pixels say
    kBetter_grey, kBetter_grey, kDistance, kAsItIs, kAsItIs,
    // 20: its place
    kAsItIs, kAsItIs, kAsItIs, kAsItIs,
    // 24: distances from the blocks around and from the pair of pictures before
    kDistance, kDistance, kShort, kShort,
    // 28: the whole picture
    kAsItIs, kAsItIs, kAsItIs, kAsItIs, kAsItIs, kAsItIs, kAsItIs, kAsItIs,
    // 36: its mean motion relative to the background
    kRelative_px, kRelative_px, kDistance, kAsItIs,
    // 40: along and across the direction in which depth moves a still scene
    kDistance, kRelative_px, kAsItIs, kAsItIs};

/// The same as factors: y = ± ln(1 + |x| · inside) · outside + x · kept.
struct Factors {
  float inside[kFeatures] = {};
  float outside[kFeatures] = {};
  float kept[kFeatures] = {};

  constexpr Factors() {
    for (int k = 0; k < kFeatures; ++k) {
      const bool stays = kScales[k].unit == 0;
      inside[k] = stays ? 0 : 1 / kScales[k].unit;
      outside[k] = stays ? 0 : 1 / kScales[k].divisor;
      kept[k] = stays;
    }
  }
};
constexpr Factors kFactors;

/// ln x to 1e-6 for x ≥ 1, which unlike std::log() compilers turn into vectors: of x = 2ⁿ m, ln m =
/// 2 artanh((m − 1) / (m + 1)) as a series, 1/√2 ≤ m < √2.
SPIDAR_INLINED float logarithm(float x) {
  constexpr int32_t kRootHalf = 0x3f3504f3;
  constexpr float kLn2 = 0.6931472f;
  int32_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  const int32_t exponent = (bits - kRootHalf) >> 23;
  bits -= exponent << 23;
  float m;
  std::memcpy(&m, &bits, sizeof m);
  const float s = (m - 1) / (m + 1);
  const float s2 = s * s;
  const float series = s * (2 + s2 * (2.0f / 3 + s2 * (2.0f / 5 + s2 * (2.0f / 7))));
  return static_cast<float>(exponent) * kLn2 + series;
}

SPIDAR_INLINED void scale_features_inlined(float* values, size_t blocks) {
  for (size_t i = 0; i < blocks; ++i, values += kFeatures) {
    for (int k = 0; k < kFeatures; ++k) {
      const float x = values[k];
      const float squashed = logarithm(1 + std::abs(x) * kFactors.inside[k]) * kFactors.outside[k];
      const float y = std::copysign(squashed, x) + x * kFactors.kept[k];
      // In this order, nothing that is not a number is left.
      const float low = y < kMostFeature ? y : kMostFeature;
      values[k] = low > -kMostFeature ? low : -kMostFeature;
    }
  }
}

}  // namespace

SPIDAR_WIDE(scale_features, (float* values, size_t blocks), (values, blocks))

}  // namespace spidar
