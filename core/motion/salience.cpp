// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/motion/salience.h"

#include <algorithm>
#include <cmath>

namespace spidar {
namespace {

/// See Region::roundness.
constexpr double kLeastRoundness = 0.02;
/// Blocks at the border divided by the square root of all blocks: 1 for a square that touches one
/// side.
constexpr double kBorder = 1.2;
/// How much touching the border lowers the score in every case.
constexpr double kBorderCost = 0.5;
/// Least speed of an object as a share of the camera's. Twice that is needed in the direction of
/// the background's motion, because parts of the scene that are nearer move like this.
constexpr double kLeastShareOfCamera = 0.2;
/// A region that moves against the background by less than this many standard deviations of the
/// blocks that follow the background is one of the scene's layers: the further the layers are
/// apart, the more each differs from a single model of them all.
constexpr double kNoiseSigmas = 5;
/// An object that was followed before may look more like a layer by this factor.
constexpr double kTrusted = 1.4;
/// A region with a smaller likelihood is not an object.
constexpr double kLeastLikelihood = 0.3;

}  // namespace

double salience(const Region& region, const CameraMotion& camera, bool was_followed) {
  if (region.roundness < kLeastRoundness) return 0;
  const double speed_px = region.relative_px.norm();
  if (speed_px == 0) return 0;
  const double touching = region.border_blocks / std::sqrt(static_cast<double>(region.blocks));
  const double score = region.blocks * kBlockArea_px * speed_px / (1 + kBorderCost * touching);
  if (camera.speed_px < camera.still_px) return score;
  // It is unknown how far a region extends if all of it is at the border.
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
