// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/motion/layers/salience.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace spidar {
namespace {

/// Blocks at the border divided by the square root of all blocks: 1 for a square that touches one
/// side.
constexpr double kBorder = 1.2;
/// A region that moves against the background by less than this many standard deviations of the
/// blocks around it is one of the scene's layers: the further the layers are apart, the more each
/// differs from a single model of them all. The limit rises with the square of
/// LayerEvidence::ratio() where that is above 1: hardly any object moves so much like a layer.
/// Chosen on real films: 6 feels motion in 0.6 % of the frames in which only the camera moves, 8 in
/// none; the gain in frames that are right is no larger than that in wrong and false ones.
constexpr double kNoiseSigmas = 8;
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

void LayerEvidence::add(const Eigen::Vector2d& relative_px_s,
                        const Eigen::Vector2d& background_px_s, double interval_s) {
  const double share = std::min(1.0, interval_s / kMean_s);
  const double newest = seen_s_ == 0 ? 1 : share;
  relative_px_s_ += newest * (relative_px_s - relative_px_s_);
  background_px_s_ += newest * (background_px_s - background_px_s_);
  seen_s_ += interval_s;
  if (seen_s_ >= kMean_s) least_ratio_ = std::min(least_ratio_, mean_ratio());
}

void LayerEvidence::add_contrast(double moved_px, double noise_px, double interval_s) {
  const double newest = has_contrast_ ? std::min(1.0, interval_s / kMean_s) : 1;
  moved_px2_ += newest * (moved_px * moved_px - moved_px2_);
  noise_px2_ += newest * (noise_px * noise_px - noise_px2_);
  has_contrast_ = true;
}

double LayerEvidence::contrast() const {
  if (noise_px2_ == 0) return std::numeric_limits<double>::infinity();
  return std::sqrt(moved_px2_ / noise_px2_);
}

double LayerEvidence::mean_ratio() const {
  const double relative_px_s = relative_px_s_.norm();
  // Without any motion of its own nothing shows that a region is more than a layer.
  constexpr double kLeast_px_s = 1e-6;
  return (relative_px_s_ + background_px_s_).norm() / std::max(relative_px_s, kLeast_px_s);
}

double LayerEvidence::ratio() const {
  return std::min(mean_ratio(), least_ratio_);
}

double salience(const Region& region, const LayerEvidence& evidence, const CameraMotion& camera,
                bool was_followed) {
  if (region.roundness < MotionBlock::kLeastRoundness) return 0;
  const double speed_px = region.relative_px.norm();
  const double side_px = std::sqrt(region.blocks * kBlockArea_px);
  const double score = side_px * speed_px;
  if (!camera.moves) return score;
  // The other layer of a scene with two is the ground. A large object that the camera follows goes
  // against the background.
  const bool moves_with_it = evidence.mean_ratio() > kTrusted;
  if (moves_with_it && region.blocks > kOtherLayer * camera.blocks) return 0;
  // It is unknown how far a region extends if all of it is at the border.
  if (!was_followed && region.border_blocks == region.blocks) return 0;
  const double trust = was_followed ? kTrusted : 1;
  if (region.graphics_blocks >= kMixedShare * trust * region.blocks) return 0;
  const double doubt = std::max(1.0, evidence.ratio() / trust);
  if (trust * evidence.contrast() < kNoiseSigmas * doubt * doubt) return 0;
  const double touching = region.border_blocks / std::sqrt(static_cast<double>(region.blocks));
  const double inside = 1 / (1 + std::pow(touching / (kBorder * trust), 4));
  const double likelihood = inside / (doubt * doubt);
  return likelihood < kLeastLikelihood ? 0 : likelihood * score;
}

}  // namespace spidar
