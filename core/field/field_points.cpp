// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/field/field_points.h"

#include <algorithm>
#include <cmath>

#include "core/tracking/corner.h"
#include "core/tracking/pixel_scale.h"

namespace spidar {
namespace {

constexpr size_t kMostPoints = 512;
/// Where blocks want kSome points, one of so many in each row and column gets one.
constexpr int kBlocksForOne = 3;
constexpr MatchSettings kMatch{4, 0.02f, 2};

/// Block of the grid at a place of the base; outside the grid, the nearest block.
size_t block_of(const BlockField& field, ImagePoint base_px) {
  const BlockGrid& grid = field.grid();
  const auto scale = static_cast<float>(field.scale());
  const auto index = [scale](float px, int begin_px, int count) {
    const float place = ((px + 0.5f) / scale - static_cast<float>(begin_px)) / kBlock_px;
    return std::clamp(static_cast<int>(std::floor(place)), 0, count - 1);
  };
  const int column = index(base_px.x_px, grid.left_px, grid.columns);
  const int row = index(base_px.y_px, grid.top_px, grid.rows);
  return static_cast<size_t>(row * grid.columns + column);
}

/// Where a point of the picture before should be now, px of the base.
ImagePoint expected(const BlockField& field, ImagePoint at) {
  const auto scale = static_cast<float>(field.scale());
  const auto moved = [&](ImagePoint place) {
    const MotionBlock& block = field.blocks()[block_of(field, place)];
    return ImagePoint{at.x_px + scale * block.moved_x_px, at.y_px + scale * block.moved_y_px};
  };
  // Blocks belong to the new picture, so the block at the old place gives only a first estimate of
  // the new place, and the block there gives the result.
  return moved(moved(at));
}

}  // namespace

FieldPoints::FieldPoints() {
  points_.reserve(kMostPoints);
  tracks_.reserve(kMostPoints);
  windows_.reserve(kMostPoints);
}

size_t FieldPoints::block_at(const ReducedFrame& reduced, const BlockField& field,
                             ImagePoint frame_px) {
  return block_of(field, to_reduced(frame_px, reduced.factor()));
}

/// Follows the point to the new frame. Returns false when it is lost.
bool FieldPoints::find(Point& point, const FineWindow& fine, const ImageView& frame,
                       const ReducedFrame& reduced, const BlockField& field) {
  WindowTemplate<kPointWindow_px> window;
  if (!window.read(ReadablePixels(reduced.before()), point.at)) return false;
  WindowMatch match;
  match.centre = expected(field, point.at);
  MatchSettings settings = kMatch;
  settings.reach_px = kMostOff_px * static_cast<float>(field.scale());
  if (!window.find(ReadablePixels(reduced.base()), settings, match)) return false;
  if (!match.is_same_thing()) return false;
  const auto inside = [](float px, int size) {
    return px > kPointWindow_px / 2 && px < static_cast<float>(size - kPointWindow_px / 2);
  };
  if (!inside(match.centre.x_px, reduced.base().width()) ||
      !inside(match.centre.y_px, reduced.base().height())) {
    return false;
  }
  const auto factor = static_cast<float>(reduced.factor());
  CoarsePlace coarse;
  coarse.at = {point.frame.x_px + factor * (match.centre.x_px - point.at.x_px),
               point.frame.y_px + factor * (match.centre.y_px - point.at.y_px)};
  coarse.variance_px2 = match.variance_px2;
  coarse.strength = window.strength();
  const bool has_finer = refines_ && reduced.factor() > 1;
  point.frame = has_finer ? fine.place(neighbourhood_, frame, reduced.factor(), coarse) : coarse.at;
  point.at = to_reduced(point.frame, reduced.factor());
  return true;
}

void FieldPoints::follow(const ImageView& frame, const ReducedFrame& reduced,
                         const BlockField& field) {
  tracks_.clear();
  size_t kept = 0;
  for (size_t i = 0; i < points_.size(); ++i) {
    const ImagePoint from = points_[i].frame;
    if (!find(points_[i], windows_[i], frame, reduced, field)) continue;
    tracks_.push_back({points_[i].id, from, points_[i].frame});
    if (kept < i) points_[kept] = points_[i];
    ++kept;
  }
  points_.resize(kept);
}

void FieldPoints::add(PointWish wish, const ReducedFrame& reduced, const BlockField& field,
                      const std::vector<PointWish>& wishes, const Settings& settings) {
  const BlockGrid& grid = field.grid();
  const PaddedImage& base = reduced.base();
  const auto scale = static_cast<float>(field.scale());
  const auto most = std::min(static_cast<size_t>(settings.most), kMostPoints);
  for (size_t i = 0; i < wishes.size() && points_.size() < most; ++i) {
    if (wishes[i] != wish || taken_[i] != 0) continue;
    const int column = static_cast<int>(i) % grid.columns;
    const int row = static_cast<int>(i) / grid.columns;
    if (wish == PointWish::kSome && (column % kBlocksForOne != 1 || row % kBlocksForOne != 1)) {
      continue;
    }
    const auto base_px = [scale](int px) {
      return static_cast<int>(static_cast<float>(px) * scale);
    };
    PixelBox box;
    box.x0 = std::max(base_px(grid.x_px(column)), kPointWindow_px / 2);
    box.y0 = std::max(base_px(grid.y_px(row)), kPointWindow_px / 2);
    box.x1 = std::min(base_px(grid.x_px(column) + kBlock_px), base.width() - kPointWindow_px / 2);
    box.y1 = std::min(base_px(grid.y_px(row) + kBlock_px), base.height() - kPointWindow_px / 2);
    if (box.x1 - box.x0 < kCornerWindow_px || box.y1 - box.y0 < kCornerWindow_px) continue;
    const Corner corner = best_corner(base, box);
    if (corner.strength < MotionBlock::kRegularization) continue;
    points_.emplace_back();
    Point& point = points_.back();
    point.id = next_id_++;
    point.at = corner.at;
    point.frame = to_frame(corner.at, reduced.factor());
    taken_[i] = 1;
  }
}

void FieldPoints::choose(const ImageView& frame, const ReducedFrame& reduced,
                         const BlockField& field, const std::vector<PointWish>& wishes,
                         const Settings& settings) {
  refines_ = settings.refines;
  taken_.assign(wishes.size(), 0);
  size_t kept = 0;
  for (size_t i = 0; i < points_.size(); ++i) {
    const size_t block = block_of(field, points_[i].at);
    if (wishes[block] == PointWish::kNone || taken_[block] != 0) continue;
    taken_[block] = 1;
    if (kept < i) points_[kept] = points_[i];
    ++kept;
  }
  points_.resize(std::min(kept, static_cast<size_t>(settings.most)));
  add(PointWish::kMany, reduced, field, wishes, settings);
  add(PointWish::kSome, reduced, field, wishes, settings);
  if (windows_.size() < points_.size()) windows_.resize(points_.size());
  if (!refines_ || reduced.factor() == 1) return;
  for (size_t i = 0; i < points_.size(); ++i) {
    windows_[i].read(neighbourhood_, frame, points_[i].frame);
  }
}

}  // namespace spidar
