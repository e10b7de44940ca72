// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Which block is where in a picture.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <Eigen/Core>

#include "core/field/block_kernels.h"

namespace spidar {

/// Blocks side by side, centred on the picture and numbered row by row. The strip that is left at
/// each border is narrower than a block.
struct BlockGrid {
  int columns = 0;
  int rows = 0;
  Eigen::Vector2i corner_px{0, 0};  ///< upper left pixel of the first block

  static BlockGrid over(int width, int height) {
    const Eigen::Vector2i size_px(width, height);
    const Eigen::Vector2i blocks = size_px / kBlock_px;
    return {blocks.x(), blocks.y(), (size_px - blocks * kBlock_px) / 2};
  }

  size_t size() const { return static_cast<size_t>(columns * rows); }
  size_t index(int column, int row) const { return static_cast<size_t>(row * columns + column); }
  int column(size_t block) const { return static_cast<int>(block) % columns; }
  int row(size_t block) const { return static_cast<int>(block) / columns; }

  /// The upper left pixel of a block.
  Eigen::Vector2i corner_of(size_t block) const {
    return corner_px + kBlock_px * Eigen::Vector2i(column(block), row(block));
  }
  /// The block that contains a position, in px from the corner of the picture, or the nearest one.
  size_t block_at(const Eigen::Vector2d& at_px) const {
    const Eigen::Vector2d blocks = (at_px - corner_px.cast<double>()) / kBlock_px;
    const auto inside = [](double position, int count) {
      return std::clamp(static_cast<int>(std::floor(position)), 0, count - 1);
    };
    return index(inside(blocks.x(), columns), inside(blocks.y(), rows));
  }

  /// How many blocks lie between this one and the nearest side in each direction.
  int columns_beside(size_t block) const {
    return std::min(column(block), columns - 1 - column(block));
  }
  int rows_beside(size_t block) const { return std::min(row(block), rows - 1 - row(block)); }

  /// Calls `visit(other)` for a block and all others that are at most `reach` columns and rows
  /// away.
  template <typename Visit>
  void each_around(size_t block, int reach, Visit&& visit) const {
    const int left = std::max(column(block) - reach, 0);
    const int right = std::min(column(block) + reach, columns - 1);
    const int last = std::min(row(block) + reach, rows - 1);
    for (int y = std::max(row(block) - reach, 0); y <= last; ++y) {
      for (int x = left; x <= right; ++x) visit(index(x, y));
    }
  }
  /// Whether that holds for a block or one of its eight neighbours.
  template <typename Is>
  bool any_around(size_t block, Is&& is) const {
    bool any = false;
    each_around(block, 1, [&](size_t other) { any = any || is(other); });
    return any;
  }
  /// Calls `visit(other)` for the blocks at the left, at the right, above and below.
  template <typename Visit>
  void each_beside(size_t block, Visit&& visit) const {
    if (column(block) > 0) visit(block - 1);
    if (column(block) + 1 < columns) visit(block + 1);
    if (row(block) > 0) visit(block - static_cast<size_t>(columns));
    if (row(block) + 1 < rows) visit(block + static_cast<size_t>(columns));
  }
};

}  // namespace spidar
