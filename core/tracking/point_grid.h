// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Where in the picture points are wanted.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/tracking/corner.h"
#include "core/tracking/gray_pyramid.h"
#include "core/tracking/tracker.h"

namespace spidar {

/// Cells over the picture, one point each; four each, a quarter of the cell apart, where
/// neighbouring points move differently: at the border of an object, which may be smaller than a
/// cell. Cells are searched in turn, those that lost a point at once.
class PointGrid {
 public:
  /// A picture of `width` × `height` px, cells of `cell_px`, made even and no less than a window.
  /// Forgets everything when one of them has changed.
  void lay_out(int width, int height, int cell_px);

  /// Nothing is known of the picture any more.
  void reset();

  /// A new frame: no cell has a point. `scarce`: there are hardly points left, and cells that are
  /// not dense keep one only.
  void begin_frame(bool scarce = false);

  /// False when the place is taken and the point should go.
  bool occupy(ImagePoint at, ImagePoint moved);

  /// A point was lost there: something may have come over it. The cell is searched in this frame
  /// and will be dense.
  void lose(ImagePoint at);

  /// Compares neighbours after the last occupy(): where they differ, or where something moves and
  /// most cells around have no point, points will be dense for some frames.
  void compare_neighbours();

  /// Makes cells dense that look different from before though their points stand still: something
  /// moves there that has none. Points are then wanted where the change is. The two pictures are
  /// `scale` times as small as that of lay_out().
  void notice_changes(const PaddedImage& before, const PaddedImage& now, int scale);

  /// Points in the cell of a point and around it, and those of them that move as it does.
  struct Support {
    int beside = 0;
    int alike = 0;
  };
  Support support(ImagePoint at, ImagePoint moved) const;

  /// What a new point there may be expected to do: what one next to it did; (0, 0) without any.
  ImagePoint motion_near(ImagePoint at) const;

  /// Calls `found(PixelBox, bool is_empty)` for each place that wants a point and is searched in
  /// this frame; `everywhere`: in all cells. `is_empty`: the cell has none yet. Boxes are such that
  /// windows in them are inside the picture and their centres inside the place.
  template <typename Found>
  void for_each_wanted(bool everywhere, Found&& found) const {
    for (int row = 0; row < rows_; ++row) {
      for (int column = 0; column < columns_; ++column) {
        const Cell& cell = cells_[index(column, row)];
        const bool turn = (row + column) % kTurns == turn_;
        if (!everywhere && !turn && !cell.search) continue;
        if (cell.dense_frames == 0) {
          if (cell.taken == 0) found(box(2 * column, 2 * row, 2), true);
          continue;
        }
        for (int quarter = 0; quarter < kQuarters; ++quarter) {
          if (cell.has(quarter)) continue;
          found(cell.changes(quarter) ? cell.changed[static_cast<size_t>(quarter)]
                                      : box(2 * column + quarter % 2, 2 * row + quarter / 2, 1),
                cell.taken == 0);
        }
      }
    }
  }

  /// Frames until every cell has had its turn.
  static constexpr int kTurns = 4;

 private:
  static constexpr int kQuarters = 4;
  struct Cell {
    std::array<ImagePoint, kQuarters> moved;  ///< of the points, where taken
    uint8_t taken = 0;                        ///< quarters, a bit each
    bool search = false;
    uint8_t dense_frames = 0;  ///< for how long

    uint8_t changing = 0;                       ///< quarters that show a change, a bit each
    std::array<PixelBox, kQuarters> changed{};  ///< where

    bool changes(int quarter) const { return (changing & (1 << quarter)) != 0; }
    bool has(int quarter) const { return (taken & (1 << quarter)) != 0; }
  };

  size_t index(int column, int row) const {
    return static_cast<size_t>(row) * static_cast<size_t>(columns_) + static_cast<size_t>(column);
  }
  int column_of(ImagePoint at) const { return place(at.x_px, columns_); }
  int row_of(ImagePoint at) const { return place(at.y_px, rows_); }
  int place(float px, int count) const;
  int quarter_of(ImagePoint at) const;
  size_t cell_of(ImagePoint at) const { return index(column_of(at), row_of(at)); }
  /// Calls `each(cell)` for a cell and the eight around it.
  template <typename Each>
  void around(int column, int row, Each&& each) const;
  /// The part of `quarter` that has changed; false when hardly anything has.
  static bool find_change(const PaddedImage& before, const PaddedImage& now, int scale,
                          const PixelBox& quarter, PixelBox& part);
  PixelBox box(int quarter_x, int quarter_y, int quarters) const;

  int width_ = 0;
  int height_ = 0;
  int cell_px_ = 0;
  int columns_ = 0;
  int rows_ = 0;
  int turn_ = 0;
  int most_in_cell_ = 0;  ///< that is not dense
  std::vector<Cell> cells_;
};

}  // namespace spidar
