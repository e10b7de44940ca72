// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/field/motion_block.h"

#include <algorithm>

#include <Eigen/LU>

namespace spidar {

using Eigen::Vector2f;
using Eigen::Vector2i;

MotionBlock refined_block(const PaddedImage& before, const PaddedImage& now,
                          const Vector2i& corner_px, const BlockMatch& match,
                          float regularization) {
  const BlockSums s =
      compare_blocks(pixels_at(now, corner_px), pixels_at(before, corner_px + match.from_px));

  // Derivatives are 1/4 of the sums' units. An offset common to all pixels is not motion.
  const auto mean = [](int32_t sum) { return static_cast<float>(sum) / kBlockArea_px; };
  const Vector2f g(mean(s.x), mean(s.y));
  const float d = mean(s.difference);
  MotionBlock block;
  Eigen::Matrix2f& S = block.structure;
  S << mean(s.xx), mean(s.xy), mean(s.xy), mean(s.yy);
  S = (S - g * g.transpose()) / 16;
  const Vector2f gd = (Vector2f(mean(s.xd), mean(s.yd)) - g * d) / 4;
  const float dd = mean(s.squared) - d * d;

  // now(p) = before(p + from − e): e = −(Σ g gᵀ)⁻¹ Σ g d.
  const Eigen::Matrix2f regularized = S + regularization * Eigen::Matrix2f::Identity();
  const Vector2f e = (-(regularized.inverse() * gd)).cwiseMax(-kMostOff_px).cwiseMin(kMostOff_px);
  const float left = dd + 2 * e.dot(gd) + e.dot(S * e);
  block.centre_px =
      corner_px.cast<float>() +
      0.5f * (Vector2i::Constant(kBlock_px) - Vector2i(now.width(), now.height())).cast<float>();
  block.moved_px = e - match.from_px.cast<float>();
  block.residual = std::max(0.0f, left);
  block.difference = match.difference;
  return block;
}

}  // namespace spidar
