// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/motion/layers/regions.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/quantile.h"

namespace spidar {
namespace {

/// Whether a block is at the border of the film, or of the part of the film that was in the
/// previous picture. How far a layer of the scene extends beyond that border is unknown.
bool is_at_border(const BlockGrid& grid, const std::vector<RelativeBlock>& relative, size_t block) {
  bool is_unknown = grid.columns_beside(block) == 0 || grid.rows_beside(block) == 0;
  grid.each_beside(block, [&](size_t other) { is_unknown |= relative[other].was_outside; });
  return is_unknown;
}

/// Blocks at the border divided by the square root of all blocks: a region with more is a layer
/// that extends beyond the border. 1 for a square that touches one side, 2 for one in a corner.
constexpr double kBorder = 1.5;
/// A region that moves against the background by less than this many standard deviations of the
/// blocks around it is one of the scene's layers: the further apart the layers are, the more each
/// differs from the single model of them all. If LayerEvidence::ratio() is above 1, the limit rises
/// with its square, because hardly any object moves so much like a layer.
constexpr double kNoiseSigmas = 8;
/// An object that was followed before may look more like a layer by this factor.
constexpr double kTrusted = 1.4;
/// A region with a larger fraction of blocks at graphics is the edge of the graphics, mixed with
/// the film behind them.
constexpr double kMixedFraction = 0.5;

}  // namespace

int RegionFinder::root_of(int block) {
  auto i = static_cast<size_t>(block);
  while (parent_[i] != static_cast<int>(i)) {
    parent_[i] = parent_[static_cast<size_t>(parent_[i])];
    i = static_cast<size_t>(parent_[i]);
  }
  return static_cast<int>(i);
}

void RegionFinder::join(int a, int b) {
  a = root_of(a);
  b = root_of(b);
  parent_[static_cast<size_t>(std::max(a, b))] = std::min(a, b);
}

void RegionFinder::describe(const BlockField& field, const std::vector<RelativeBlock>& relative,
                            Region& region, int16_t label) {
  const BlockGrid& grid = field.grid();
  const Eigen::Vector2d half_px = Eigen::Vector2d::Constant(kBlock_px / 2);
  moved_px_.clear();
  Eigen::Matrix2d tensor = Eigen::Matrix2d::Zero();
  region.low_px.setConstant(1e9);
  region.high_px.setConstant(-1e9);
  for (size_t i = 0; i < labels_.size(); ++i) {
    if (labels_[i] != label) continue;
    const MotionBlock& block = field.blocks()[i];
    ++region.blocks;
    region.lasts |= relative[i].lasts;
    region.border_blocks += is_at_border(grid, relative, i);
    region.graphics_blocks +=
        grid.any_around(i, [&](size_t other) { return relative[other].is_occluded; });
    const Eigen::Vector2d at_px = block.centre_px.cast<double>();
    region.position_px += at_px;
    region.low_px = region.low_px.cwiseMin(at_px - half_px);
    region.high_px = region.high_px.cwiseMax(at_px + half_px);
    region.background_px += relative[i].background_px.cast<double>();
    tensor += block.structure.cast<double>();
    moved_px_.push_back(relative[i].moved_px);
  }
  region.roundness = roundness(tensor);
  region.position_px /= region.blocks;
  region.background_px /= region.blocks;
  region.relative_px = median_of_each(moved_px_).cast<double>();
}

const std::vector<Region>& RegionFinder::find(const BlockField& field,
                                              const std::vector<RelativeBlock>& relative) {
  const BlockGrid& grid = field.grid();
  const auto n = relative.size();
  moved_px_.reserve(n);
  parent_.resize(n);
  for (size_t i = 0; i < n; ++i) parent_[i] = static_cast<int>(i);
  for (size_t i = 0; i < n; ++i) {
    if (!relative[i].moves) continue;
    grid.each_around(i, 1, [&](size_t other) {
      const bool is_before = other < i;  // a later block joins this one when its turn comes
      if (is_before && relative[other].moves &&
          are_alike(relative[i].moved_px, relative[other].moved_px)) {
        join(static_cast<int>(i), static_cast<int>(other));
      }
    });
  }

  regions_.clear();
  region_of_root_.assign(n, kNoRegion);
  labels_.assign(n, kNoRegion);
  for (size_t i = 0; i < n; ++i) {
    if (!relative[i].moves) continue;
    const auto root = static_cast<size_t>(root_of(static_cast<int>(i)));
    if (region_of_root_[root] == kNoRegion) {
      region_of_root_[root] = static_cast<int16_t>(regions_.size());
      regions_.emplace_back();
    }
    labels_[i] = region_of_root_[root];
  }
  for (size_t k = 0; k < regions_.size(); ++k) {
    describe(field, relative, regions_[k], static_cast<int16_t>(k));
  }
  return regions_;
}

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
  if (region.roundness < MotionBlock::kMinRoundness) return 0;
  const double speed_px = region.relative_px.norm();
  const double side_px = std::sqrt(region.blocks * kBlockArea_px);
  const double score = side_px * speed_px;
  if (!camera_moves) return score;
  // The size of a region that is entirely at the border is unknown.
  if (!was_followed && region.border_blocks == region.blocks) return 0;
  const double trust = was_followed ? kTrusted : 1;
  if (region.graphics_blocks >= kMixedFraction * trust * region.blocks) return 0;
  if (region.border_blocks > kBorder * trust * std::sqrt(region.blocks)) return 0;
  const double doubt = std::max(1.0, evidence.ratio() / trust);
  return trust * evidence.contrast() < kNoiseSigmas * doubt * doubt ? 0 : score;
}

}  // namespace spidar
