// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/motion/salience.h"

#include <algorithm>
#include <cmath>

namespace spidar {
namespace {

/// See Region::roundness.
constexpr double kLeastRoundness = 0.02;
/// Blocks at the border over the square root of all: 1 for a square that leans against one side.
constexpr double kBorder = 1.2;
/// How much the score falls with it in any case.
constexpr double kBorderCost = 0.5;
/// Speed as a share of the camera's that an object has at least, and twice that when it goes the
/// same way as the background, as what is nearer does.
constexpr double kLeastShareOfCamera = 0.2;
/// What is slower than so many standard deviations of what follows the background is one of the
/// scene's layers: the further they are apart, the more they differ from any model of all of them.
constexpr double kNoiseSigmas = 5;
/// What was followed before may be so much more like a layer.
constexpr double kTrusted = 1.4;
/// What is less of an object than this is none.
constexpr double kLeastLikelihood = 0.3;

}  // namespace

double salience(const Region& region, const CameraMotion& camera, bool was_followed) {
  if (region.roundness < kLeastRoundness) return 0;
  const double speed_px = region.relative_px.norm();
  if (speed_px == 0) return 0;
  const double touching = region.border_blocks / std::sqrt(static_cast<double>(region.blocks));
  const double score = region.blocks * kBlockArea_px * speed_px / (1 + kBorderCost * touching);
  if (camera.speed_px < camera.still_px) return score;
  // Of what is at the border as a whole nobody sees where it ends.
  if (!was_followed && region.border_blocks == region.blocks) return 0;
  const double trust = was_followed ? kTrusted : 1;
  if (speed_px * trust < kNoiseSigmas * camera.noise_px) return 0;
  const double inside = 1 / (1 + std::pow(touching / (kBorder * trust), 4));
  const double along_px = region.relative_px.dot(region.background_px.normalized());
  const double least_px =
      kLeastShareOfCamera * camera.speed_px * (1 + std::max(0.0, along_px / speed_px));
  const double share = speed_px * trust / least_px;
  const double likelihood = inside * std::min(1.0, share * share);
  return likelihood < kLeastLikelihood ? 0 : likelihood * score;
}

}  // namespace spidar
