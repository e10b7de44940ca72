// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/motion/layers/regions.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "core/motion/camera/robust_fit.h"
#include "core/quantile.h"

namespace spidar {
namespace {

bool move_alike(const RelativeBlock& a, const RelativeBlock& b) {
  return are_alike({a.x_px, a.y_px}, {b.x_px, b.y_px});
}

/// Whether a block is at the border of the film, or of the part of it that was in the previous
/// picture: how far a layer of the scene extends beyond is unknown.
bool is_at_border(const BlockGrid& grid, const std::vector<RelativeBlock>& relative, int column,
                  int row) {
  if (column == 0 || row == 0 || column + 1 == grid.columns || row + 1 == grid.rows) return true;
  const auto columns = static_cast<size_t>(grid.columns);
  const size_t i = static_cast<size_t>(row) * columns + static_cast<size_t>(column);
  const auto is_unknown = [&](size_t k) { return relative[k].was_outside; };
  return is_unknown(i - 1) || is_unknown(i + 1) || is_unknown(i - columns) ||
         is_unknown(i + columns);
}

/// Whether something burned in covers the block or one of its eight neighbours.
bool is_beside_graphics(const BlockGrid& grid, const std::vector<RelativeBlock>& relative,
                        int column, int row) {
  for (int j = std::max(row - 1, 0); j <= std::min(row + 1, grid.rows - 1); ++j) {
    for (int i = std::max(column - 1, 0); i <= std::min(column + 1, grid.columns - 1); ++i) {
      if (relative[static_cast<size_t>(j * grid.columns + i)].is_occluded) return true;
    }
  }
  return false;
}

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
  x_px_.clear();
  y_px_.clear();
  Eigen::Matrix2d tensor = Eigen::Matrix2d::Zero();
  region.low_px.setConstant(1e9);
  region.high_px.setConstant(-1e9);
  for (size_t i = 0; i < labels_.size(); ++i) {
    if (labels_[i] != label) continue;
    const MotionBlock& block = field.blocks()[i];
    const int column = static_cast<int>(i) % grid.columns;
    const int row = static_cast<int>(i) / grid.columns;
    ++region.blocks;
    region.lasts |= relative[i].lasts;
    region.border_blocks += is_at_border(grid, relative, column, row);
    region.graphics_blocks += is_beside_graphics(grid, relative, column, row);
    const Eigen::Vector2d at_px(block.x_px, block.y_px);
    region.position_px += at_px;
    region.low_px =
        region.low_px.cwiseMin(at_px.array().matrix() - Eigen::Vector2d::Constant(kBlock_px / 2));
    region.high_px = region.high_px.cwiseMax(at_px + Eigen::Vector2d::Constant(kBlock_px / 2));
    region.background_px +=
        Eigen::Vector2d(relative[i].background_x_px, relative[i].background_y_px);
    tensor(0, 0) += static_cast<double>(block.xx);
    tensor(0, 1) += static_cast<double>(block.xy);
    tensor(1, 1) += static_cast<double>(block.yy);
    x_px_.push_back(relative[i].x_px);
    y_px_.push_back(relative[i].y_px);
  }
  const double trace = tensor(0, 0) + tensor(1, 1);
  const double root = std::hypot(tensor(0, 0) - tensor(1, 1), 2 * tensor(0, 1));
  region.roundness = trace > 0 ? (trace - root) / (trace + root) : 0;
  region.position_px /= region.blocks;
  region.background_px /= region.blocks;
  region.relative_px.x() = static_cast<double>(median(x_px_.begin(), x_px_.end()));
  region.relative_px.y() = static_cast<double>(median(y_px_.begin(), y_px_.end()));
}

const std::vector<Region>& RegionFinder::find(const BlockField& field,
                                              const std::vector<RelativeBlock>& relative) {
  const BlockGrid& grid = field.grid();
  const auto n = relative.size();
  x_px_.reserve(n);
  y_px_.reserve(n);
  parent_.resize(n);
  for (size_t i = 0; i < n; ++i) parent_[i] = static_cast<int>(i);
  const auto moves = [&](int column, int row) {
    return column >= 0 && row >= 0 && column < grid.columns &&
           relative[static_cast<size_t>(row * grid.columns + column)].moves;
  };
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      if (!moves(column, row)) continue;
      const int i = row * grid.columns + column;
      const auto alike = [&](int j) {
        return move_alike(relative[static_cast<size_t>(i)], relative[static_cast<size_t>(j)]);
      };
      if (moves(column - 1, row) && alike(i - 1)) join(i, i - 1);
      for (int k = -1; k <= 1; ++k) {
        if (moves(column + k, row - 1) && alike(i - grid.columns + k))
          join(i, i - grid.columns + k);
      }
    }
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

}  // namespace spidar
