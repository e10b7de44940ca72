// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/field/block_field.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "core/quantile.h"

namespace spidar {
namespace {

using Eigen::Vector2f;
using Eigen::Vector2i;

/// Σ |pixel − mean| of a block.
int difference_from_mean(const PaddedImage& picture, const Vector2i& at_px) {
  int sum = 0;
  for (int y = 0; y < kBlock_px; ++y) {
    const uint8_t* row = picture.row(at_px.y() + y) + at_px.x();
    for (int x = 0; x < kBlock_px; ++x) sum += row[x];
  }
  const int mean = (sum + kBlockArea_px / 2) / kBlockArea_px;
  int difference = 0;
  for (int y = 0; y < kBlock_px; ++y) {
    const uint8_t* row = picture.row(at_px.y() + y) + at_px.x();
    for (int x = 0; x < kBlock_px; ++x) difference += std::abs(row[x] - mean);
  }
  return difference;
}

/// A block is lost if what it differs from its best match is more than this fraction of what it
/// differs from its own mean: the match shows something else.
constexpr double kFoundElsewhere = 0.5;
/// Fraction of the textured blocks that are lost at a cut.
constexpr double kLostAtCut = 0.8;
/// Fraction of the textured blocks that are found again even where noise hides that of most others.
constexpr double kBestFraction = 0.02;
/// Mean difference that noise may make: that of σ = 5.3. With 8, another part of a synthetic
/// texture, which looks alike everywhere, is taken for the same part with noise.
constexpr int kMostNoise_grey = 6;

double squared(double value) {
  return value * value;
}

bool is_finite_motion(const Vector2f& moved_px) {
  constexpr float kMost_px = 4096;
  return std::abs(moved_px.x()) < kMost_px && std::abs(moved_px.y()) < kMost_px;
}

/// A position between pixels.
struct Position {
  Vector2i pixel;
  Vector2i fraction;  ///< of kFractionOne

  Position(const Vector2i& begin_px, const Vector2f& moved_px) {
    for (int axis = 0; axis < 2; ++axis) {
      const float position = static_cast<float>(begin_px[axis]) + moved_px[axis];
      pixel[axis] = static_cast<int>(std::floor(position));
      fraction[axis] =
          static_cast<int>((position - static_cast<float>(pixel[axis])) * kFractionOne + 0.5f);
    }
  }
};

}  // namespace

void BlockField::resize(const PaddedImage& base) {
  base_width_ = base.width();
  base_height_ = base.height();
  scale_ = field_scale(base_width_, base_height_);
  has_picture_ = false;
}

void BlockField::reduce(const PaddedImage& base) {
  reduce_to_field(base, scale_, now_);
  reduce_blocks(now_.view(), kCoarser, coarse_.now);
  coarse_.now.repeat_border();
}

/// Nothing but the picture is known. Nothing of what was before a cut is left, either, so that an
/// analysis that begins before a cut goes on behind it as every other one does.
void BlockField::begin() {
  has_picture_ = true;
  pictures_back_ = 0;
  grid_ = BlockGrid::over(now_.width(), now_.height());
  matches_.assign(grid_.size(), BlockMatch());
  coarse_.grid = BlockGrid::over(coarse_.now.width(), coarse_.now.height());
  coarse_.matches.assign(coarse_.grid.size(), BlockMatch());
  blocks_.assign(grid_.size(), MotionBlock());
  textured_.reserve(blocks_.size());
  residuals_.reserve(blocks_.size());
}

BlockField::Result BlockField::update(const PaddedImage& base) {
  if (base.width() != base_width_ || base.height() != base_height_) resize(base);
  std::rotate(earlier_.begin(), earlier_.end() - 1, earlier_.end());
  std::swap(earlier_.front(), now_);
  std::swap(coarse_.before, coarse_.now);
  reduce(base);
  if (!has_picture_) {
    begin();
    earlier_.front().resize(now_.width(), now_.height());
    return Result::kFirst;
  }
  compensate_light(coarse_.before, coarse_.now, earlier_.front());
  find_hints();
  search_.find(before(), now_, grid_, hints_, matches_);
  if (is_cut()) {
    begin();
    return Result::kCut;
  }
  for (size_t i = 0; i < blocks_.size(); ++i) {
    blocks_[i] = refined_block(before(), now_, grid_.corner_of(i), matches_[i],
                               MotionBlock::kRegularization);
  }
  measure_noise();
  pictures_back_ = std::min(pictures_back_ + 1, kMostBack);
  stands_still_ = false;
  return Result::kMoved;
}

void BlockField::measure_noise() {
  residuals_.clear();
  for (const MotionBlock& block : blocks_) residuals_.push_back(block.residual);
  noise_grey2_ = quantile(residuals_, 1 / 3.0);
}

/// After a cut, the best matches of all blocks are doubtful on the mean, and nearly all of the
/// textured blocks are lost. In a picture that moves, however fast, some blocks still match. What
/// the best of them differ by is noise, up to kMostNoise_grey. The noise of both pictures is part
/// of each difference, and that of one of them part of each contrast.
bool BlockField::is_cut() {
  int64_t between = 0;
  for (const BlockMatch& match : matches_) between += match.difference;
  const auto pixels = static_cast<int64_t>(grid_.size()) * kBlockArea_px;
  if (between < kDoubtful_grey * pixels) return false;
  textured_.clear();
  for (size_t i = 0; i < matches_.size(); ++i) {
    const int contrast = contrast_of(i);
    if (contrast < kDoubtful_grey * kBlockArea_px) continue;
    textured_.push_back({squared(matches_[i].difference), squared(contrast)});
  }
  if (textured_.empty()) return false;
  const auto count = static_cast<double>(textured_.size());
  const auto best = textured_.begin() + static_cast<ptrdiff_t>(kBestFraction * count);
  std::nth_element(
      textured_.begin(), best, textured_.end(),
      [](const Textured& a, const Textured& b) { return a.difference2 < b.difference2; });
  const double noise2 = std::min(best->difference2, squared(kMostNoise_grey * kBlockArea_px));
  const auto is_lost = [&](const Textured& block) {
    return block.difference2 - noise2 > squared(kFoundElsewhere) * (block.contrast2 - noise2 / 2);
  };
  const auto lost = std::count_if(textured_.begin(), textured_.end(), is_lost);
  return static_cast<double>(lost) > kLostAtCut * count;
}

int BlockField::contrast_of(size_t block) const {
  return difference_from_mean(now_, grid_.corner_of(block));
}

BlockField::Match BlockField::match_of(size_t block) const {
  const int contrast = contrast_of(block);
  if (contrast < kDoubtful_grey * kBlockArea_px) return Match::kPlain;
  return matches_[block].difference > kFoundElsewhere * contrast ? Match::kLost : Match::kFound;
}

/// Searches a picture of a quarter of the resolution, in which each block covers four by four of
/// the others and is searched over the whole range: this finds objects that have jumped.
void BlockField::find_hints() {
  hints_.clear();
  if (coarse_.grid.size() == 0) return;
  search_.find(coarse_.before, coarse_.now, coarse_.grid, hints_, coarse_.matches);
  for (size_t i = 0; i < grid_.size(); ++i) {
    const Vector2i middle_px = grid_.corner_of(i) + Vector2i::Constant(kBlock_px / 2);
    BlockMatch hint = coarse_.matches[coarse_.grid.block_at((middle_px / kCoarser).cast<double>())];
    hint.from_px *= kCoarser;
    hints_.push_back(hint);
  }
}

void BlockField::stand_still() {
  stands_still_ = true;
  for (BlockMatch& match : matches_) match = BlockMatch();
  for (MotionBlock& block : blocks_) {
    block.moved_px.setZero();
    block.residual = 0;
    block.difference = 0;
  }
  noise_grey2_ = 0;
}

/// Whether a block may begin between this pixel and the next ones in both directions.
bool BlockField::is_in_reach(const Vector2i& corner_px) const {
  const Vector2i last_px(now_.width() - kBlock_px - 1, now_.height() - kBlock_px - 1);
  return (corner_px.array() >= -kBlockReach_px).all() &&
         ((corner_px - last_px).array() <= kBlockReach_px).all();
}

size_t BlockField::origin_of(size_t index) const {
  const Vector2f& moved_px = blocks_[index].moved_px;
  const auto back = [](int position, float by_px, int count) {
    // Clamped first: half a block outside is the first or the last one. std::lround() would be a
    // call, three times for each block.
    const float from = static_cast<float>(position) - by_px / kBlock_px;
    const double inside = std::clamp(static_cast<double>(from), 0.0, count - 1.0);
    return static_cast<int>(inside + 0.5);
  };
  return grid_.index(back(grid_.column(index), moved_px.x(), grid_.columns),
                     back(grid_.row(index), moved_px.y(), grid_.rows));
}

int BlockField::difference_if_moved(size_t block, const Vector2f& moved_px) const {
  if (!is_finite_motion(moved_px)) return -1;
  const Vector2i corner_px = grid_.corner_of(block);
  const Position from(corner_px, -moved_px);
  if (!is_in_reach(from.pixel)) return -1;
  const BlockPixels here = pixels_at(now_, corner_px);
  int least = bilinear_difference(here, pixels_at(before(), from.pixel), from.fraction.x(),
                                  from.fraction.y());
  for (const Vector2i& next : {Vector2i(0, 0), Vector2i(1, 0), Vector2i(0, 1), Vector2i(1, 1)}) {
    const BlockPixels there = pixels_at(before(), from.pixel + next);
    least = std::min(least, block_difference(here, there, least));
  }
  return least;
}

std::optional<int> BlockField::better_if_moved(size_t block, int back,
                                               const Vector2i& from_px) const {
  const Vector2i corner_px = grid_.corner_of(block);
  const Vector2i begin_px = corner_px + from_px;
  const Vector2i end_px = begin_px + Vector2i::Constant(kBlock_px);
  if (begin_px.minCoeff() < 0 || end_px.x() > now_.width() || end_px.y() > now_.height()) {
    return std::nullopt;
  }
  const PaddedImage& then = earlier_[static_cast<size_t>(back - 1)];
  const BlockPixels here = pixels_at(now_, corner_px);
  return cell_difference(here, pixels_at(then, corner_px)) -
         cell_difference(here, pixels_at(then, begin_px));
}

StayingPixels BlockField::staying_pixels(size_t block, const Vector2f& moved_px,
                                         const Vector2i& beside_px) const {
  if (!is_finite_motion(moved_px)) return {};
  const Vector2i corner_px = grid_.corner_of(block) + beside_px;
  const Position from(corner_px, -moved_px);
  const Position to(corner_px, moved_px);
  if (!is_in_reach(corner_px) || !is_in_reach(from.pixel) || !is_in_reach(to.pixel)) return {};
  const auto moved = [](const PaddedImage& picture, const Position& at) {
    return MovedBlock{pixels_at(picture, at.pixel), at.fraction.x(), at.fraction.y()};
  };
  return spidar::staying_pixels(pixels_at(now_, corner_px), pixels_at(before(), corner_px),
                                moved(before(), from), moved(now_, to));
}

}  // namespace spidar
