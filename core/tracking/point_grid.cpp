// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/tracking/point_grid.h"

#include <algorithm>
#include <cstdlib>

namespace spidar {
namespace {

/// Neighbours whose motions differ by more than this share of the motion, and by more than this
/// many pixels, do not belong to the same object. A zoom by 10 % a frame stays below the limit.
constexpr float kDifferent = 0.2f;
constexpr float kDifferent_px = 0.75f;
/// Change of one pixel that counts; the noise is much smaller after 16 pixels are averaged.
constexpr int kChanged_grey = 8;
/// Fewer changed pixels count as flicker.
constexpr int kLeastChanged = 2;
constexpr uint8_t kDenseFrames = 12;
/// Points that have come in from neighbouring cells may stay.
constexpr int kMostInCell = 2;

/// Rotation (rad) or scaling of up to 0.05 per frame still counts as one motion; points one cell
/// apart may differ by this share of their distance.
constexpr float kTurn = 0.05f;

bool alike(ImagePoint a, ImagePoint b, float least_px = kDifferent_px) {
  const auto squared = [](float x, float y) { return x * x + y * y; };
  const float motion = std::max(squared(a.x_px, a.y_px), squared(b.x_px, b.y_px));
  return squared(a.x_px - b.x_px, a.y_px - b.y_px) <=
         least_px * least_px + kDifferent * kDifferent * motion;
}

int points_in(unsigned taken) {
  int count = 0;
  for (; taken != 0; taken &= taken - 1) ++count;
  return count;
}

size_t lowest_quarter(unsigned taken) {
  size_t quarter = 0;
  while ((taken & (1u << quarter)) == 0) ++quarter;
  return quarter;
}

/// Leaves room for the larger window that refines a point, or less if the picture is small.
int border_px(int size) {
  return std::clamp((size - kCornerWindow_px) / 4, 2, 5);
}

}  // namespace

void PointGrid::lay_out(int width, int height, int cell_px) {
  cell_px = std::max(cell_px / 2 * 2, kCornerWindow_px);
  if (width == width_ && height == height_ && cell_px == cell_px_) return;
  width_ = width;
  height_ = height;
  cell_px_ = cell_px;
  columns_ = (width + cell_px - 1) / cell_px;
  rows_ = (height + cell_px - 1) / cell_px;
  cells_.assign(static_cast<size_t>(columns_) * static_cast<size_t>(rows_), {});
}

void PointGrid::reset() {
  turn_ = 0;
  std::fill(cells_.begin(), cells_.end(), Cell());
}

void PointGrid::begin_frame(bool scarce) {
  most_in_cell_ = scarce ? 1 : kMostInCell;
  turn_ = (turn_ + 1) % kTurns;
  for (Cell& cell : cells_) {
    cell.taken = 0;
    cell.search = false;
    cell.changing = 0;
    if (cell.dense_frames > 0) --cell.dense_frames;
  }
}

int PointGrid::place(float px, int count) const {
  return std::clamp(static_cast<int>(px) / cell_px_, 0, count - 1);
}

int PointGrid::quarter_of(ImagePoint at) const {
  const auto second_half = [this](float px) {
    return static_cast<int>(px) % cell_px_ >= cell_px_ / 2 ? 1 : 0;
  };
  return second_half(at.x_px) + 2 * second_half(at.y_px);
}

template <typename Each>
void PointGrid::around(int column, int row, Each&& each) const {
  for (int y = std::max(row - 1, 0); y <= std::min(row + 1, rows_ - 1); ++y) {
    for (int x = std::max(column - 1, 0); x <= std::min(column + 1, columns_ - 1); ++x) {
      each(cells_[index(x, y)]);
    }
  }
}

void PointGrid::lose(ImagePoint at) {
  Cell& cell = cells_[cell_of(at)];
  cell.search = true;
  cell.dense_frames = kDenseFrames;
}

bool PointGrid::occupy(ImagePoint at, ImagePoint moved) {
  Cell& cell = cells_[cell_of(at)];
  const int quarter = quarter_of(at);
  const bool crowded = cell.dense_frames == 0 && points_in(cell.taken) >= most_in_cell_;
  if (crowded || cell.has(quarter)) return false;
  cell.moved[static_cast<size_t>(quarter)] = moved;
  cell.taken = static_cast<uint8_t>(cell.taken | 1 << quarter);
  return true;
}

void PointGrid::compare_neighbours() {
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; ++column) {
      Cell& cell = cells_[index(column, row)];
      if (cell.taken == 0) continue;
      const ImagePoint moved = cell.moved[lowest_quarter(cell.taken)];
      int cells = 0;
      int points = 0;
      bool differs = false;
      around(column, row, [&](const Cell& other) {
        ++cells;
        for (size_t k = 0; k < kQuarters; ++k) {
          if (!other.has(static_cast<int>(k))) continue;
          ++points;
          differs = differs || !alike(moved, other.moved[k]);
        }
      });
      const bool alone = 2 * points < cells && !alike(moved, {0, 0});
      if (!differs && !alone) continue;
      cell.dense_frames = kDenseFrames;
      cell.search = true;
    }
  }
}

bool PointGrid::find_change(const PaddedImage& before, const PaddedImage& now, int scale,
                            const PixelBox& quarter, PixelBox& part) {
  int changed = 0;
  int x0 = quarter.x1;
  int x1 = quarter.x0;
  int y0 = quarter.y1;
  int y1 = quarter.y0;
  for (int y = quarter.y0 / scale; y < quarter.y1 / scale; ++y) {
    for (int x = quarter.x0 / scale; x < quarter.x1 / scale; ++x) {
      if (std::abs(before.row(y)[x] - now.row(y)[x]) < kChanged_grey) continue;
      ++changed;
      x0 = std::min(x0, x * scale);
      x1 = std::max(x1, (x + 1) * scale);
      y0 = std::min(y0, y * scale);
      y1 = std::max(y1, (y + 1) * scale);
    }
  }
  if (changed < kLeastChanged) return false;
  // Leaves room for a window centred on the change.
  part.x0 = std::max(x0 - kCornerWindow_px / 2, quarter.x0);
  part.y0 = std::max(y0 - kCornerWindow_px / 2, quarter.y0);
  part.x1 = std::min(std::max(x1 + kCornerWindow_px / 2, part.x0 + kCornerWindow_px), quarter.x1);
  part.y1 = std::min(std::max(y1 + kCornerWindow_px / 2, part.y0 + kCornerWindow_px), quarter.y1);
  return true;
}

void PointGrid::notice_changes(const PaddedImage& before, const PaddedImage& now, int scale) {
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; ++column) {
      Cell& cell = cells_[index(column, row)];
      if (cell.taken != 0 && !alike(cell.moved[lowest_quarter(cell.taken)], {0, 0})) continue;
      for (int quarter = 0; quarter < kQuarters; ++quarter) {
        PixelBox& part = cell.changed[static_cast<size_t>(quarter)];
        const PixelBox whole = box(2 * column + quarter % 2, 2 * row + quarter / 2, 1);
        if (!find_change(before, now, scale, whole, part)) continue;
        cell.changing = static_cast<uint8_t>(cell.changing | 1 << quarter);
        cell.dense_frames = kDenseFrames;
        cell.search = true;
      }
    }
  }
}

PointGrid::Support PointGrid::support(ImagePoint at, ImagePoint moved) const {
  const Cell& own = cells_[cell_of(at)];
  const auto quarter = static_cast<size_t>(quarter_of(at));
  Support support;
  const float least_px = kDifferent_px + kTurn * static_cast<float>(cell_px_);
  around(column_of(at), row_of(at), [&](const Cell& other) {
    for (size_t k = 0; k < kQuarters; ++k) {
      if (!other.has(static_cast<int>(k)) || (&other == &own && k == quarter)) continue;
      ++support.beside;
      if (alike(moved, other.moved[k], least_px)) ++support.alike;
    }
  });
  return support;
}

ImagePoint PointGrid::motion_near(ImagePoint at) const {
  const Cell& own = cells_[cell_of(at)];
  if (own.taken != 0) return own.moved[lowest_quarter(own.taken)];
  ImagePoint moved;
  bool found = false;
  around(column_of(at), row_of(at), [&](const Cell& other) {
    if (found || other.taken == 0) return;
    found = true;
    moved = other.moved[lowest_quarter(other.taken)];
  });
  return moved;
}

PixelBox PointGrid::box(int quarter_x, int quarter_y, int quarters) const {
  const int half_px = cell_px_ / 2;
  // The centre of an 8 px window is 3.5 px from its first pixel.
  constexpr int kBefore_px = kCornerWindow_px / 2 - 1;
  constexpr int kAfter_px = kCornerWindow_px / 2;
  const auto first = [&](int quarter, int size) {
    return std::max(quarter * half_px - kBefore_px, border_px(size));
  };
  const auto last = [&](int quarter, int size) {
    return std::min((quarter + quarters) * half_px + kAfter_px, size - border_px(size));
  };
  return {first(quarter_x, width_), first(quarter_y, height_), last(quarter_x, width_),
          last(quarter_y, height_)};
}

}  // namespace spidar
