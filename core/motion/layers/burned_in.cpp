// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/motion/layers/burned_in.h"

#include <algorithm>
#include <cmath>

#include "core/motion/camera/border.h"
#include "core/motion/camera/motion_models.h"
#include "core/quantile.h"

namespace spidar {
namespace {

/// The largest width of a bar on one side, as a fraction of the picture, rounded to whole lines:
/// the bar beside a film of 4:3 in a picture of 16:9. (The bars of 2.35:1 in 16:9 are a little
/// narrower.) If wider bars counted, a large box in front of a still scene without noise would pass
/// for a film in a frame.
constexpr double kMaxOfSide = (1 - (4 / 3.0) / (16 / 9.0)) / 2;

/// At least this fraction of the edge between the film and a bar must change; the rest of the
/// film's edge may be plain or dark.
constexpr double kChangedFraction = 0.8;

/// The rows, or the columns, of blocks as seen from one side of the picture.
struct Side {
  const BlockField& field;
  bool are_columns;
  bool from_end;  ///< line 0 is the last row or column
  int across;     ///< number of blocks at each end of a line that do not count

  int lines() const { return are_columns ? field.grid().columns : field.grid().rows; }
  int positions() const { return are_columns ? field.grid().rows : field.grid().columns; }

  bool has_changed(int line, int position) const {
    if (from_end) line = lines() - 1 - line;
    const size_t block =
        are_columns ? field.grid().index(line, position) : field.grid().index(position, line);
    const auto difference = static_cast<float>(field.difference_if_moved(block, {0, 0}));
    return difference > kRounding_grey * kBlockArea_px;
  }

  bool is_still(int line) const {
    for (int position = across; position < positions() - across; ++position) {
      if (has_changed(line, position)) return false;
    }
    return true;
  }

  /// The number of still lines from this side inwards, or 0 if there are too many for a bar.
  int still_lines() const {
    const auto most = static_cast<int>(std::lround(kMaxOfSide * lines()));
    int n = 0;
    while (n <= most && is_still(n)) ++n;
    return n > most ? 0 : n;
  }

  /// Marks the positions at which `line`, the first one that is not still, or the line after it has
  /// changed: the edge of the film may be anywhere in `line`. Returns whether enough are marked.
  bool is_edge(int line, std::vector<uint8_t>& changed) const {
    int all = 0;
    for (int position = across; position < positions() - across; ++position) {
      uint8_t& mark = changed[static_cast<size_t>(position)];
      if (mark == 0) mark = has_changed(line, position) || has_changed(line + 1, position);
      all += mark;
    }
    return all >= kChangedFraction * (positions() - 2 * across);
  }
};

/// The fraction of equal pixels that shows graphics in a block that has moved: halfway between
/// kExactOfGraphics and 1, because saturated white and black parts of an object have no noise
/// either.
constexpr double kExactElsewhere = (1 + kExactOfGraphics) / 2;
/// For a block with static graphics the search can find a motion of up to kMaxOff_px, because some
/// pixels of the block are of the film. A block that moved by less than half of kMaxOff_px, px of
/// the field's picture, counts as not moved.
constexpr float kInPlace_px = kMaxOff_px / 2;
/// If this many pixels of a block that has moved stay in place, the block shows both graphics and
/// the film behind them, and its motion is that of neither. The number is a tenth of the block,
/// more than a line across it.
constexpr int kMixedPixels = 24;
/// A dark or still part of a picture has less noise than the rest. The noise around a block is
/// measured in the blocks up to kAround_blocks away whose motion differs from the background's by
/// less than kWithBackground_px (px of the field's picture); there must be kMinAround of them.
constexpr int kAround_blocks = 4;
constexpr float kWithBackground_px = 1.5F;
constexpr size_t kMinAround = 8;
/// In a block that has moved by less than kStill_px (px of the field's picture), noise explains a
/// residual of up to kStillCost times the noise: four standard deviations of its mean over a block.
/// The limit can be so low because a camera seldom follows an object so exactly.
constexpr float kStill_px = 0.2F;
constexpr float kStillCost = 1.4F;
/// The score of a block: each pair of pictures in which the block is constant adds kGain, every
/// other pair subtracts 1. While the score is at least kLasting, which takes two constant pairs,
/// the block counts as burned in without a new sign, for at most five further pairs.
constexpr int kGain = 3;
constexpr int kLasting = kGain + 1;
constexpr int kMaxScore = 3 * kGain;
/// Constant pixels are also searched this far beside a block: the edge of a bar may be just
/// outside.
constexpr int kBesideBlock_px = kBlock_px / 4;

}  // namespace

void Margins::Bars::begin(int width) {
  blocks = width;
  pairs = 0;
  for (auto& positions : changed) std::fill(positions.begin(), positions.end(), uint8_t{0});
}

/// Updates the bars at two opposite sides. Known bars stay while the still lines are as many as
/// before, to within a block; unknown ones begin again when fewer lines are still.
void Margins::update_bars(Bars& bars, const BlockField& field, bool are_columns, int across) {
  const Side first{field, are_columns, false, across};
  const Side last{field, are_columns, true, across};
  const int at_first = first.still_lines();
  const int at_last = at_first == 0 ? 0 : last.still_lines();
  const int fewer = std::min(at_first, at_last);
  const int blocks = std::max(at_first, at_last) + 1;
  const bool alike = fewer > 0 && blocks <= fewer + 2;
  if (bars.is_known() && fewer + 2 >= bars.blocks) return;
  if (!alike) return bars.begin(0);
  if (bars.is_known() || bars.blocks == 0 || blocks < bars.blocks) bars.begin(blocks);
  for (auto& positions : bars.changed) positions.resize(static_cast<size_t>(first.positions()));
  const int edge = bars.blocks - 1;
  const bool begins = first.is_edge(edge, bars.changed[0]);
  const bool ends = last.is_edge(edge, bars.changed[1]);
  bars.pairs += begins && ends;
}

void Margins::update(const BlockField& field) {
  const int rows_before = rows();
  const int columns_before = columns();
  update_bars(rows_, field, false, columns());
  update_bars(columns_, field, true, rows());
  have_changed_ = rows() != rows_before || columns() != columns_before;
}

void Margins::reset() {
  rows_.begin(0);
  columns_.begin(0);
  have_changed_ = false;
}

void BurnedIn::reset() {
  margins_.reset();
  lasting_.clear();
  contained_.clear();
  occluded_.clear();
}

void BurnedIn::begin(const BlockField& field, bool camera_moves) {
  const size_t blocks = field.blocks().size();
  margins_.update(field);
  signs_.assign(blocks, Sign::kNone);
  if (lasting_.size() != blocks) lasting_.assign(blocks, 0);
  camera_moves_ = camera_moves;
  nearby_.reserve((2 * kAround_blocks + 1) * (2 * kAround_blocks + 1));
}

/// The median of the residuals, grey², of the blocks around `block` that move with the background.
/// Nothing if there are too few of them.
std::optional<float> BurnedIn::noise_around_grey2(const BlockField& field, const Block& block) {
  nearby_.clear();
  field.grid().each_around(block.index, kAround_blocks, [&](size_t i) {
    const MotionBlock& other = field.blocks()[i];
    const float apart_px2 = (other.moved_px - block.background_px).squaredNorm();
    if (apart_px2 < kWithBackground_px * kWithBackground_px) nearby_.push_back(other.residual);
  });
  if (nearby_.size() < kMinAround) return std::nullopt;
  return median(nearby_.begin(), nearby_.end());
}

/// Whether neither the motion of the block nor noise of up to twice the standard deviation explains
/// the pixels of the block.
bool BurnedIn::is_unexplained(const BlockField& field, const Block& block, float moved_px) {
  const auto most = static_cast<float>(kMaxCost);
  const float residual = field.blocks()[block.index].residual;
  if (residual > most * field.noise_grey2()) return true;
  const std::optional<float> around_grey2 = noise_around_grey2(field, block);
  return around_grey2 && residual > (moved_px < kStill_px ? kStillCost : most) * *around_grey2;
}

bool BurnedIn::stays_beside(const BlockField& field, const Block& block) const {
  const auto stays = [&](int x_px, int y_px) {
    return are_graphics(field.staying_pixels(block.index, block.background_px, {x_px, y_px}),
                        kExactElsewhere);
  };
  return stays(-kBesideBlock_px, 0) || stays(kBesideBlock_px, 0) || stays(0, -kBesideBlock_px) ||
         stays(0, kBesideBlock_px);
}

void BurnedIn::classify(const BlockField& field, const Block& block) {
  if (!camera_moves_) return;
  const MotionBlock& own = field.blocks()[block.index];
  const float moved_px = std::hypot(own.moved_px.x(), own.moved_px.y());
  const StayingPixels staying = field.staying_pixels(block.index, block.background_px);
  Sign& sign = signs_[block.index];
  if (are_graphics(staying, moved_px < kMaxOff_px ? kExactOfGraphics : kExactElsewhere)) {
    sign = Sign::kStays;
  } else if (is_unexplained(field, block, moved_px)) {
    const bool is_mixed = block.is_slow && staying.near >= kMixedPixels;
    const bool in_place = moved_px < kInPlace_px || is_mixed;
    sign = block.is_expected            ? Sign::kUnexplained
           : stays_beside(field, block) ? Sign::kStays
           : in_place                   ? Sign::kInPlace
                                        : Sign::kUnexplained;
  }
}

void BurnedIn::end(const BlockGrid& grid) {
  for (size_t i = 0; i < signs_.size(); ++i) {
    const int change = signs_[i] == Sign::kStays ? kGain : -1;
    lasting_[i] = static_cast<uint8_t>(std::clamp(lasting_[i] + change, 0, kMaxScore));
  }
  contained_.assign(signs_.size(), 0);
  occluded_.assign(signs_.size(), 0);
  const auto lasts = [this](size_t block) { return lasting_[block] >= kLasting; };
  bool any_lasts = false;
  for (size_t i = 0; i < signs_.size(); ++i) any_lasts |= lasts(i);
  for (size_t i = 0; i < signs_.size(); ++i) {
    contained_[i] = occluded_[i] = margins_.contains(grid, i);
    if (!camera_moves_ || contained_[i] != 0) continue;
    const bool beside = any_lasts && grid.any_around(i, lasts);
    contained_[i] = signs_[i] == Sign::kStays || signs_[i] == Sign::kInPlace || lasts(i) ||
                    (signs_[i] == Sign::kUnexplained && beside);
    occluded_[i] = contained_[i] != 0 && beside;
  }
}

}  // namespace spidar
