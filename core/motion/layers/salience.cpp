// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/motion/layers/salience.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace spidar {
namespace {

/// Blocks at the border divided by the square root of all blocks, of which a region with more is a
/// layer that extends beyond the border: 1 for a square that touches one side, 2 for one in a
/// corner.
constexpr double kBorder = 1.5;
/// A region that moves against the background by less than this many standard deviations of the
/// blocks around it is one of the scene's layers: the further the layers are apart, the more each
/// differs from a single model of them all. The limit rises with the square of
/// LayerEvidence::ratio() where that is above 1: hardly any object moves so much like a layer.
constexpr double kNoiseSigmas = 8;
/// An object that was followed before may look more like a layer by this factor.
constexpr double kTrusted = 1.4;
/// A region with more of its blocks beside graphics is the edge of these, mixed with the film
/// behind it.
constexpr double kMixedFraction = 0.5;

}  // namespace

void LayerEvidence::add(const Eigen::Vector2d& relative_px, const Eigen::Vector2d& background_px,
                        double noise_px, double interval_s) {
  const double newest = is_empty_ ? 1 : std::min(1.0, interval_s / kMean_s);
  moved_px2_ += newest * (relative_px.squaredNorm() - moved_px2_);
  on_screen_px_ += newest * (relative_px + background_px - on_screen_px_);
  noise_px2_ += newest * (noise_px * noise_px - noise_px2_);
  is_empty_ = false;
}

double LayerEvidence::contrast() const {
  if (noise_px2_ == 0) return std::numeric_limits<double>::infinity();
  return std::sqrt(moved_px2_ / noise_px2_);
}

double LayerEvidence::ratio() const {
  if (moved_px2_ == 0) return std::numeric_limits<double>::infinity();
  return on_screen_px_.norm() / std::sqrt(moved_px2_);
}

double salience(const Region& region, const LayerEvidence& evidence, bool camera_moves,
                bool was_followed) {
  if (region.roundness < MotionBlock::kLeastRoundness) return 0;
  const double speed_px = region.relative_px.norm();
  const double side_px = std::sqrt(region.blocks * kBlockArea_px);
  const double score = side_px * speed_px;
  if (!camera_moves) return score;
  // It is unknown how far a region extends if all of it is at the border.
  if (!was_followed && region.border_blocks == region.blocks) return 0;
  const double trust = was_followed ? kTrusted : 1;
  if (region.graphics_blocks >= kMixedFraction * trust * region.blocks) return 0;
  if (region.border_blocks > kBorder * trust * std::sqrt(region.blocks)) return 0;
  const double doubt = std::max(1.0, evidence.ratio() / trust);
  return trust * evidence.contrast() < kNoiseSigmas * doubt * doubt ? 0 : score;
}

}  // namespace spidar
