// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/field/coarse_blocks.h"

#include <algorithm>

namespace spidar {
namespace {

using Eigen::Vector2i;

/// A coarse block with fewer counted pixels than a block of the field covers there is empty.
constexpr int kMinPixels = kBlockArea_px / (kCoarser * kCoarser);

}  // namespace

void CoarseBlocks::reserve(const BlockField& field) {
  blocks_.reserve(field.blocks().size());
  counted_.resize(field.coarse().now.width(), field.coarse().now.height());
}

void CoarseBlocks::exclude_blocks_with_corners(const BlockField& field) {
  const Vector2i size_px(counted_.width(), counted_.height());
  for (int y = 0; y < size_px.y(); ++y) {
    std::fill_n(counted_.row(y), size_px.x(), static_cast<uint8_t>(255));
  }
  const BlockGrid& grid = field.grid();
  for (size_t i = 0; i < grid.size(); ++i) {
    if (!field.blocks()[i].has_corners()) continue;
    // Every pixel that the block touches.
    const Vector2i begin_px = grid.corner_of(i) / kCoarser;
    const Vector2i end_px =
        (grid.corner_of(i) + Vector2i::Constant(kBlock_px + kCoarser - 1)) / kCoarser;
    const Vector2i last_px = end_px.cwiseMin(size_px);
    for (int y = begin_px.y(); y < last_px.y(); ++y) {
      std::fill(counted_.row(y) + begin_px.x(), counted_.row(y) + last_px.x(),
                static_cast<uint8_t>(0));
    }
  }
}

/// The best match among rest and the motions of the blocks of the coarse field that this one
/// overlaps or touches.
BlockMatch CoarseBlocks::best_match(const CoarseField& coarse, const Vector2i& corner_px) const {
  const BlockPixels here = pixels_at(coarse.now, corner_px);
  const BlockPixels counted = pixels_at(counted_, corner_px);
  const Vector2i last_px =
      Vector2i(coarse.now.width(), coarse.now.height()) - Vector2i::Constant(kBlock_px);
  BlockMatch best;
  best.difference = block_difference(here, pixels_at(coarse.before, corner_px), counted);
  const Vector2i middle_px = corner_px + Vector2i::Constant(kBlock_px / 2);
  const size_t middle = coarse.grid.block_at(middle_px.cast<double>());
  Vector2i tried_px(0, 0);
  coarse.grid.each_around(middle, 1, [&](size_t block) {
    const Vector2i& from_px = coarse.matches[block].from_px;
    // Repeated candidates are skipped: neighbours mostly move alike.
    if (from_px == tried_px || from_px == best.from_px || from_px.isZero()) return;
    tried_px = from_px;
    const Vector2i begin_px = corner_px + from_px;
    if ((begin_px.array() < -kBlockReach_px).any() ||
        ((begin_px - last_px).array() > kBlockReach_px).any()) {
      return;
    }
    const int difference = block_difference(here, pixels_at(coarse.before, begin_px), counted);
    if (difference < best.difference) best = {from_px, difference};
  });
  return best;
}

const std::vector<MotionBlock>& CoarseBlocks::find(const BlockField& field) {
  blocks_.clear();
  const CoarseField& coarse = field.coarse();
  if (field.pictures_back() == 0 || coarse.grid.size() == 0) return blocks_;
  reserve(field);
  exclude_blocks_with_corners(field);
  constexpr int kStep_px = kBlock_px / 2;
  const Vector2i size_px(coarse.now.width(), coarse.now.height());
  const Vector2i last_px = size_px - Vector2i::Constant(kBlock_px);
  const Vector2i field_px(field.picture().width(), field.picture().height());
  const Eigen::Vector2f to_centre_px = 0.5f * (kCoarser * size_px - field_px).cast<float>();
  for (int y = last_px.y() % kStep_px / 2; y <= last_px.y(); y += kStep_px) {
    for (int x = last_px.x() % kStep_px / 2; x <= last_px.x(); x += kStep_px) {
      const Vector2i corner_px(x, y);
      const BlockMatch match = best_match(coarse, corner_px);
      const BlockSums sums = compare_blocks(pixels_at(coarse.now, corner_px),
                                            pixels_at(coarse.before, corner_px + match.from_px),
                                            pixels_at(counted_, corner_px));
      MotionBlock block = refined_block(sums, coarse.now, corner_px, match,
                                        MotionBlock::kRegularization * kCoarseTextureScale);
      if (sums.pixels < kMinPixels) block.structure.setZero();
      block.moved_px *= kCoarser;
      block.centre_px = kCoarser * block.centre_px + to_centre_px;
      blocks_.push_back(block);
    }
  }
  return blocks_;
}

}  // namespace spidar
