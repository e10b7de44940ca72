// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/motion/camera/border.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace spidar {
namespace {

/// The width of the ring of blocks along the border. With a narrower ring, a strip beside the
/// blocks, or a dark edge of the picture, would decide.
constexpr int kRingBlocks = 2;
/// An object is cut by at most this many borders, those of a corner. If more borders cut an object,
/// it is a part of the scene.
constexpr int kMaxOfObject = 2;

/// Standard deviation of | a | − | b | over that of a and b, which are normal and independent: √(2
/// (1 − 2 / π)).
constexpr double kOfTwoSizes = 0.853;
/// Two differences of a block, Σ over its pixels, are unequal if they are further apart than this
/// many standard deviations of noise, and than what an encoder changes in a wall at rest.
constexpr double kUnequalSigmas = 2;
constexpr double kCoded = static_cast<double>(kRounding_grey) * kBlockArea_px;

int borders_of(uint32_t object, const BlockField& field, const PreviousFrame& past) {
  const BlockGrid& grid = field.grid();
  const int first_column = past.margin_columns, last_column = grid.columns - 1 - first_column;
  const int first_row = past.margin_rows, last_row = grid.rows - 1 - first_row;
  bool left = false, right = false, above = false, below = false;
  const auto is_its = [&](int column, int row) {
    return past.object_of(field.origin_of(grid.index(column, row))) == object;
  };
  for (int row = first_row; row <= last_row; ++row) {
    left |= is_its(first_column, row);
    right |= is_its(last_column, row);
  }
  for (int column = first_column; column <= last_column; ++column) {
    above |= is_its(column, first_row);
    below |= is_its(column, last_row);
  }
  return left + right + above + below;
}

/// The distance beyond which two differences of a block are unequal, Σ over its pixels.
double clearly_unequal(const BlockField& field) {
  const double of_noise =
      kBlock_px * kOfTwoSizes * std::sqrt(static_cast<double>(field.noise_grey2()));
  return std::max(kCoded, kUnequalSigmas * of_noise);
}

/// Calls `visit(block)` for each block of the ring that shows the film.
template <typename Visit>
void each_at_border(const BlockField& field, const PreviousFrame& past, Visit&& visit) {
  const BlockGrid& grid = field.grid();
  for (size_t i = 0; i < grid.size(); ++i) {
    const int across = grid.columns_beside(i) - past.margin_columns;
    const int down = grid.rows_beside(i) - past.margin_rows;
    const bool is_inside = across >= kRingBlocks && down >= kRingBlocks;
    if (across < 0 || down < 0 || is_inside || past.is_burned_in(i)) continue;
    visit(i);
  }
}

/// A model is a function of the earlier position, which one step of iteration finds.
Eigen::Vector2f motion_of(const BlockField& field, size_t block, const MotionModel& model) {
  const Eigen::Vector2d at_px = field.blocks()[block].centre_px.cast<double>();
  return model.displacement_px(at_px - model.displacement_px(at_px)).cast<float>();
}

/// The fewest pixels that show whether a block stays: a line across it.
constexpr int kMinStaying = kBlock_px;

/// The largest distance, px of the field's picture, between a block's own motion and that of a
/// fitting model: the error of motion before it is refined.
constexpr float kFits_px = kMaxOff_px / 2;

bool shows_graphics(const BlockField& field, size_t block, const Eigen::Vector2f& moved_px) {
  return are_graphics(field.staying_pixels(block, moved_px), kExactOfGraphics);
}

}  // namespace

bool are_graphics(const StayingPixels& staying, double least_exact) {
  const double near = staying.near;
  return near >= kMinStaying && staying.exact > least_exact * near + std::sqrt(near) / 2;
}

bool border_has_moved(const BlockField& field, const PreviousFrame& past,
                      const MotionModel& model) {
  const double clearly = clearly_unequal(field);
  uint32_t asked = 0;  // neighbours are mostly of one object
  bool is_left_out = false;
  int all = 0;
  int left_out = 0;
  int moved = 0;
  int rest = 0;
  each_at_border(field, past, [&](size_t i) {
    const uint32_t object = past.object_of(field.origin_of(i));
    if (object != 0 && object != asked) {
      asked = object;
      is_left_out = borders_of(object, field, past) <= kMaxOfObject;
    }
    if (object != 0 && is_left_out) {
      ++left_out;
      return;
    }
    const Eigen::Vector2f moved_px = motion_of(field, i, model);
    const int if_moved = field.difference_if_moved(i, moved_px);
    if (if_moved < 0) return;
    const int at_rest = field.difference_if_moved(i, {0, 0});
    ++all;
    // Interpolation between pixels reduces noise, so any motion may fit better than rest: the
    // opposite motion must not.
    moved += at_rest - if_moved > clearly &&
             field.difference_if_moved(i, -moved_px) - if_moved > clearly;
    rest += if_moved - at_rest > clearly;
  });
  return all > left_out && moved - rest > kMoreThanRest * all;
}

double divide_border(const BlockField& field, const PreviousFrame& past,
                     const std::vector<MotionModel>& models, std::vector<double>& shares) {
  const double clearly = clearly_unequal(field);
  const BlockGrid& grid = field.grid();
  const bool moves = models.front().kind != ModelKind::kStill;
  const bool is_single = models.size() == 1;
  shares.assign(models.size(), 0);
  int all = 0;
  int telling = 0;
  each_at_border(field, past, [&](size_t i) {
    // Neighbours are mostly alike: for a single model, every other block suffices.
    if (is_single && (grid.column(i) + grid.row(i)) % 2 != 0) return;
    ++all;
    const Eigen::Vector2f first_px = motion_of(field, i, models.front());
    const float off_px2 = (field.blocks()[i].moved_px - first_px).squaredNorm();
    if (is_single && off_px2 < kFits_px * kFits_px) return;
    std::array<int, kMaxModels> differences{};
    int least = field.blocks()[i].difference;
    int most = 0;
    for (size_t k = 0; k < models.size(); ++k) {
      differences[k] =
          field.difference_if_moved(i, k == 0 ? first_px : motion_of(field, i, models[k]));
      if (differences[k] >= 0) least = std::min(least, differences[k]);
      most = std::max(most, differences[k]);
    }
    if (most - least <= clearly) return;
    const auto fits = [&](int difference) {
      return difference >= 0 && difference - least <= clearly;
    };
    if (moves && !fits(differences.front()) && shows_graphics(field, i, first_px)) return;
    ++telling;
    const auto end = differences.begin() + static_cast<ptrdiff_t>(models.size());
    const auto fitting = std::count_if(differences.begin(), end, fits);
    for (size_t k = 0; k < models.size(); ++k) {
      if (fits(differences[k])) shares[k] += 1.0 / static_cast<double>(fitting);
    }
  });
  if (all == 0) return 0;
  for (double& share : shares) share /= all;
  return static_cast<double>(telling) / all;
}

}  // namespace spidar
