// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/motion/camera/camera_choice.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace spidar {
namespace {

/// Blocks from the border inwards: with fewer, a strip that is left beside the blocks, or a dark
/// edge of the picture, would decide.
constexpr int kRingBlocks = 2;
/// More of them than this fraction must say that they have moved than that they rest. Measured in
/// rendered films, in 4594 pictures in which areas moved and blocks did not: twelve pictures became
/// right for each that became wrong, with half of it eight, with none three.
constexpr double kRingShare = 0.2;
/// A known object is cut by so many borders at most, one in a corner. What more of them cut is a
/// part of the scene that was taken for an object.
constexpr int kMostOfObject = 2;

/// Standard deviation of | a | − | b | over that of a and b, which are normal and independent:
/// √(2 (1 − 2 / π)).
constexpr double kOfTwoSizes = 0.853;
/// Differences of a block, Σ over its pixels, are unequal if they are further apart than so many
/// standard deviations of what noise gives, and than what an encoder changes in a wall at rest.
constexpr double kUnequalSigmas = 2;
constexpr double kCoded = static_cast<double>(kRounding_grey) * kBlockArea_px;

/// How many borders of the film cut an object.
int borders_of(uint32_t object, const BlockField& field, const Past& past) {
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

/// Fraction of the blocks that must differ less from the earlier picture if they have moved, by
/// more than kRounding_grey. Measured in made films: where the camera rests, and HEVC or AV1 moves
/// the noise of the wall with the object, it is 0.26 at most; where the camera pans over hardly
/// anything, 0.49 at least.
constexpr double kMovedShare = 0.4;
/// So many times as many must say so as say the opposite.
constexpr int kMoreOften = 2;
/// Fewer blocks say nothing: kMovedShare of so many has a standard deviation of 0.08, half of what
/// lies between the two cases above.
constexpr int kLeastPlain = 40;

}  // namespace

bool border_has_moved(const BlockField& field, const Past& past, const MotionModel& model) {
  const double of_noise =
      kBlock_px * kOfTwoSizes * std::sqrt(static_cast<double>(field.noise_grey2()));
  const double clearly = std::max(kCoded, kUnequalSigmas * of_noise);
  const BlockGrid& grid = field.grid();
  uint32_t asked = 0;  // neighbours are mostly of one object
  bool is_left_out = false;
  int all = 0;
  int left_out = 0;
  int moved = 0;
  int rest = 0;
  for (size_t i = 0; i < grid.size(); ++i) {
    const int across = grid.columns_beside(i) - past.margin_columns;
    const int down = grid.rows_beside(i) - past.margin_rows;
    const bool is_inside = across >= kRingBlocks && down >= kRingBlocks;
    if (across < 0 || down < 0 || is_inside || past.is_burned_in(i)) continue;
    const uint32_t object = past.object_of(field.origin_of(i));
    if (object != 0 && object != asked) {
      asked = object;
      is_left_out = borders_of(object, field, past) <= kMostOfObject;
    }
    if (object != 0 && is_left_out) {
      ++left_out;
      continue;
    }
    const Eigen::Vector2d at_px = field.blocks()[i].centre_px.cast<double>();
    // A model maps to the later picture; it hardly differs between the two positions.
    const Eigen::Vector2d from_px = at_px - model.displacement_px(at_px);
    const Eigen::Vector2f moved_px = model.displacement_px(from_px).cast<float>();
    const int if_moved = field.difference_if_moved(i, moved_px);
    if (if_moved < 0) continue;
    const int at_rest = field.difference_if_moved(i, {0, 0});
    ++all;
    // Between pixels, noise is less: then the contrary is as good.
    moved += at_rest - if_moved > clearly &&
             field.difference_if_moved(i, -moved_px) - if_moved > clearly;
    rest += if_moved - at_rest > clearly;
  }
  return all > left_out && moved - rest > kRingShare * all;
}

void PlainParts::remember(const BlockField& field, const MotionModel& model) {
  moved_px_.reserve(field.blocks().size());
  steps_px_.reserve(field.blocks().size());
  if (field.pictures_back() == 0) return;
  std::rotate(models_.begin(), models_.end() - 1, models_.end());
  models_.front() = model;
}

/// Finds the picture since which the models have moved the blocks furthest.
void PlainParts::go_back(const BlockField& field, const MotionModel& model) {
  const std::vector<MotionBlock>& blocks = field.blocks();
  back_ = 0;
  double furthest_px = 0;  // Σ over the blocks
  moved_px_.assign(blocks.size(), Eigen::Vector2d::Zero());
  steps_px_ = moved_px_;
  for (int back = 1; back <= field.pictures_back(); ++back) {
    const MotionModel& step = back == 1 ? model : models_[static_cast<size_t>(back - 2)];
    double sum_px = 0;
    for (size_t i = 0; i < blocks.size(); ++i) {
      const Eigen::Vector2d at_px = blocks[i].centre_px.cast<double>() - steps_px_[i];
      // A model maps to the later picture; it hardly differs between the two positions.
      const Eigen::Vector2d from_px = at_px - step.displacement_px(at_px);
      steps_px_[i] += step.displacement_px(from_px);
      sum_px += steps_px_[i].norm();
    }
    if (!(sum_px > furthest_px)) continue;
    back_ = back;
    furthest_px = sum_px;
    moved_px_ = steps_px_;
  }
}

bool PlainParts::have_moved(const BlockField& field, const Past& past, const MotionModel& model) {
  go_back(field, model);
  const double size_px = field.picture().width() + field.picture().height();
  constexpr int kClearly = static_cast<int>(kRounding_grey * kBlockArea_px);
  int all = 0;
  int better = 0;
  int worse = 0;
  for (size_t i = 0; back_ > 0 && i < moved_px_.size(); ++i) {
    if (field.blocks()[i].has_corners() || past.is_burned_in(i)) continue;
    if (!(moved_px_[i].norm() < size_px)) continue;
    const Eigen::Vector2i from_px = -moved_px_[i].array().round().cast<int>();
    const std::optional<int> gain = field.better_if_moved(i, back_, from_px);
    if (!gain) continue;
    ++all;
    better += *gain > kClearly;
    worse += *gain < -kClearly;
  }
  return all >= kLeastPlain && better > kMovedShare * all && better > kMoreOften * worse;
}

namespace {

bool moves(const Background& background) {
  return background.is_known && background.model.kind != ModelKind::kStill;
}

}  // namespace

CameraChoice::CameraChoice() {
  votes_.cast.reserve(kMostDisplacements);
  area_votes_.cast.reserve(kMostDisplacements);
}

void CameraChoice::reset() {
  plain_.reset();
  estimator_.reset();
}

/// `likely` is what explains the picture best, whether it was believed or not: over several
/// pictures the plain parts may show what they do not show in one.
const Background& CameraChoice::keep(const BlockField& field, const Background& chosen,
                                     const MotionModel& likely) {
  plain_.remember(field, likely);
  return estimator_.keep(chosen);
}

const Background& CameraChoice::find(const BlockField& field, const Past& past) {
  collect_votes(field, past, votes_);
  const bool are_few = votes_.are_few();
  const Background of_blocks = are_few ? Background() : estimator_.propose(votes_);
  if (moves(of_blocks) || votes_.are_many()) return keep(field, of_blocks, of_blocks.model);

  collect_areas(field, areas_.find(field), past, area_votes_);
  const Background of_areas =
      area_votes_.are_few() ? Background() : estimator_.propose(area_votes_);
  if (moves(of_areas) && (plain_.have_moved(field, past, of_areas.model) ||
                          border_has_moved(field, past, of_areas.model))) {
    std::swap(votes_, area_votes_);
    return keep(field, of_areas, of_areas.model);
  }
  if (!are_few) return keep(field, of_blocks, of_areas.model);

  collect_edges(field, past, votes_);
  return keep(field, estimator_.propose(votes_), of_areas.model);
}

}  // namespace spidar
