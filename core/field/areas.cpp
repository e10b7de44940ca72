// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/field/areas.h"

namespace spidar {
namespace {

using Eigen::Vector2i;

/// The best of rest and the motions of the coarse blocks that an area overlaps or touches.
BlockMatch best_match(const CoarseField& coarse, const Vector2i& corner_px) {
  const BlockPixels here = pixels_at(coarse.now, corner_px);
  const Vector2i last_px =
      Vector2i(coarse.now.width(), coarse.now.height()) - Vector2i::Constant(kBlock_px);
  BlockMatch best;
  best.difference =
      block_difference(here, pixels_at(coarse.before, corner_px), kBlockArea_px * 256);
  const Vector2i middle_px = corner_px + Vector2i::Constant(kBlock_px / 2);
  const size_t middle = coarse.grid.block_at(middle_px.cast<double>());
  Vector2i tried_px(0, 0);
  coarse.grid.each_around(middle, 1, [&](size_t block) {
    const Vector2i& from_px = coarse.matches[block].from_px;
    // Neighbours mostly move alike.
    if (from_px == tried_px || from_px == best.from_px || from_px.isZero()) return;
    tried_px = from_px;
    const Vector2i begin_px = corner_px + from_px;
    if ((begin_px.array() < -kBlockReach_px).any() ||
        ((begin_px - last_px).array() > kBlockReach_px).any()) {
      return;
    }
    const int difference =
        block_difference(here, pixels_at(coarse.before, begin_px), best.difference);
    if (difference < best.difference) best = {from_px, difference};
  });
  return best;
}

}  // namespace

void find_areas(const BlockField& field, std::vector<MotionBlock>& areas) {
  areas.clear();
  const CoarseField& coarse = field.coarse();
  if (field.pictures_back() == 0 || coarse.grid.size() == 0) return;
  constexpr int kStep_px = kBlock_px / 2;
  const Vector2i size_px(coarse.now.width(), coarse.now.height());
  const Vector2i last_px = size_px - Vector2i::Constant(kBlock_px);
  const Vector2i field_px(field.picture().width(), field.picture().height());
  const Eigen::Vector2f to_centre_px = 0.5f * (kCoarser * size_px - field_px).cast<float>();
  for (int y = last_px.y() % kStep_px / 2; y <= last_px.y(); y += kStep_px) {
    for (int x = last_px.x() % kStep_px / 2; x <= last_px.x(); x += kStep_px) {
      const Vector2i corner_px(x, y);
      MotionBlock area =
          refined_block(coarse.before, coarse.now, corner_px, best_match(coarse, corner_px),
                        MotionBlock::kRegularization * kOfAreas);
      area.moved_px *= kCoarser;
      area.centre_px = kCoarser * area.centre_px + to_centre_px;
      areas.push_back(area);
    }
  }
}

}  // namespace spidar
