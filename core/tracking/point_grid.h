// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Decides where in the picture points are needed.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/tracking/corner.h"
#include "core/tracking/gray_pyramid.h"
#include "core/tracking/tracker.h"

namespace spidar {

/// Divides the picture into cells with one point each. Dense cells have four points, one per
/// quarter. A cell becomes dense where neighbouring points move differently, as at the border of an
/// object, which may be smaller than a cell. Cells are searched in turn; those that lost a point
/// are searched at once.
class PointGrid {
 public:
  /// Lays out a picture of `width` × `height` px with cells of `cell_px`, rounded to an even number
  /// that is at least the window size. Resets the grid if one of these values has changed.
  void lay_out(int width, int height, int cell_px);

  /// Discards all knowledge of the picture.
  void reset();

  /// Begins a frame in which no cell has a point yet. With `scarce`, when hardly any points are
  /// left to assign, cells that are not dense keep only one point.
  void begin_frame(bool scarce = false);

  /// Returns false if the place is taken and the point should be dropped.
  bool occupy(ImagePoint at, ImagePoint moved);

  /// Reports a lost point, which something may have covered. Its cell is searched in this frame and
  /// becomes dense.
  void lose(ImagePoint at);

  /// Call after the last occupy(). Makes cells dense for some frames where neighbours move
  /// differently, or where a point moves and most surrounding cells have none.
  void compare_neighbours();

  /// Makes cells dense whose pixels change although their points are at rest, because something
  /// without points moves there. Points are then requested at the change. The two pictures are
  /// smaller than that of lay_out() by the factor `scale`.
  void notice_changes(const PaddedImage& before, const PaddedImage& now, int scale);

  /// Number of points in and around the cell of a point, and of those with the same motion.
  struct Support {
    int beside = 0;
    int alike = 0;
  };
  Support support(ImagePoint at, ImagePoint moved) const;

  /// Expected motion of a new point: that of a nearby point, or (0, 0) if there is none.
  ImagePoint motion_near(ImagePoint at) const;

  /// Calls `found(PixelBox, bool is_empty)` for each place that needs a point and is searched in
  /// this frame, in all cells if `everywhere`. `is_empty` means that the cell has no point yet.
  /// Windows in a box lie inside the picture, with their centres inside the place.
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

  /// Number of frames in which every cell is searched once.
  static constexpr int kTurns = 4;

 private:
  static constexpr int kQuarters = 4;
  struct Cell {
    std::array<ImagePoint, kQuarters> moved;  ///< motion of the points in occupied quarters
    uint8_t taken = 0;                        ///< occupied quarters, one bit each
    bool search = false;
    uint8_t dense_frames = 0;  ///< remaining frames in which it is dense

    uint8_t changing = 0;                       ///< quarters with a change, one bit each
    std::array<PixelBox, kQuarters> changed{};  ///< area of the change

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
  /// Finds the part of `quarter` that has changed; returns false if there is hardly any change.
  static bool find_change(const PaddedImage& before, const PaddedImage& now, int scale,
                          const PixelBox& quarter, PixelBox& part);
  PixelBox box(int quarter_x, int quarter_y, int quarters) const;

  int width_ = 0;
  int height_ = 0;
  int cell_px_ = 0;
  int columns_ = 0;
  int rows_ = 0;
  int turn_ = 0;
  int most_in_cell_ = 0;  ///< limit for cells that are not dense
  std::vector<Cell> cells_;
};

}  // namespace spidar
