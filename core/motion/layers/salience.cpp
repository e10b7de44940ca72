// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/motion/layers/salience.h"

#include <algorithm>
#include <cmath>

namespace spidar {
namespace {

/// Blocks at the border divided by the square root of all blocks: 1 for a square that touches one
/// side.
constexpr double kBorder = 1.2;
/// A region that moves against the background by less than this many standard deviations of the
/// blocks around it is one of the scene's layers: the further the layers are apart, the more each
/// differs from a single model of them all. The limit rises with the cube of
/// LayerEvidence::ratio() where that is above 1: hardly any object moves so much like a layer.
constexpr double kNoiseSigmas = 5;
/// An object that was followed before may look more like a layer by this factor.
constexpr double kTrusted = 1.4;
/// A region with a smaller likelihood is not an object. Away from the border this is a
/// LayerEvidence::ratio() above 2: a layer that is further away than half of the background's
/// distance.
constexpr double kLeastLikelihood = 0.25;

/// What moves like a layer and is larger than this share of the background is the other layer of a
/// scene with two.
constexpr double kOtherLayer = 0.5;
/// A region with more of its blocks beside graphics is the edge of these, mixed with the film
/// behind it.
constexpr double kMixedShare = 0.5;

}  // namespace

bool stands_out(const Region& region, const CameraMotion& camera) {
  return region.relative_px.norm() >= kNoiseSigmas * camera.noise_px;
}

double salience(const Region& region, const LayerEvidence& evidence, const CameraMotion& camera,
                bool was_followed) {
  if (region.roundness < MotionBlock::kLeastRoundness) return 0;
  const double speed_px = region.relative_px.norm();
  if (speed_px == 0) return 0;
  const double touching = region.border_blocks / std::sqrt(static_cast<double>(region.blocks));
  const double side_px = std::sqrt(region.blocks * kBlockArea_px);
  const double score = side_px * speed_px;
  if (!camera.moves) return score;
  if (evidence.is_on_screen()) return 0;
  // The other layer is the ground. A large object that the camera follows goes against the
  // background.
  const bool is_layer = evidence.mean_ratio() > kTrusted;
  if (is_layer && region.blocks > kOtherLayer * camera.blocks) return 0;
  // It is unknown how far a region extends if all of it is at the border.
  if (!was_followed && region.border_blocks == region.blocks) return 0;
  const double trust = was_followed ? kTrusted : 1;
  if (region.graphics_blocks >= kMixedShare * trust * region.blocks) return 0;
  const double doubt = std::max(1.0, evidence.ratio() / trust);
  // What stands out now and then only is a layer that does so by chance.
  const double in_noise = evidence.mostly_stood_out() ? trust : 1;
  if (speed_px * in_noise < kNoiseSigmas * doubt * doubt * doubt * camera.noise_px) return 0;
  const double inside = 1 / (1 + std::pow(touching / (kBorder * trust), 4));
  const double likelihood = inside / (doubt * doubt);
  return likelihood < kLeastLikelihood ? 0 : likelihood * score;
}

}  // namespace spidar
