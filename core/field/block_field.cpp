// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/field/block_field.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <utility>

#include "core/picture/image_view.h"
#include "core/picture/opencv.h"
#include "core/quantile.h"

namespace spidar {
namespace {

// A pixel of the reduced picture is 1.5 base pixels wide, so three adjacent pixels a, b, c become
// two: (2 a + b) / 3 and (b + 2 c) / 3. In 2D the weights are 4/9, 2/9, 2/9 and 1/9.

/// ninth(v) = (v + 4) / 9 for v ≤ 9 · 255, as a multiplication: 65536 / 9 rounded up is 7282, whose
/// error of 2 / 65536 / 9 a unit is below 0.01 at 2299.
constexpr unsigned kNinth = 7282;

using cv::v_uint16x8;
using cv::v_uint8x16;

v_uint8x16 ninth(const v_uint16x8& low, const v_uint16x8& high) {
  const v_uint16x8 four = cv::v_setall_u16(4);
  const v_uint16x8 factor = cv::v_setall_u16(static_cast<uint16_t>(kNinth));
  return cv::v_pack(cv::v_mul_hi(low + four, factor), cv::v_mul_hi(high + four, factor));
}

/// 48 pixels, deinterleaved by column modulo 3 and widened to 16 bits.
struct Thirds {
  std::array<v_uint16x8, 3> low;
  std::array<v_uint16x8, 3> high;

  explicit Thirds(const uint8_t* pixels) {
    std::array<v_uint8x16, 3> columns;
    cv::v_load_deinterleave(pixels, columns[0], columns[1], columns[2]);
    for (size_t k = 0; k < 3; ++k) cv::v_expand(columns[k], low[k], high[k]);
  }
};

/// Computes one reduced row: weights `outer` twice and `middle` once, then reduces the columns.
void store_pairs(const Thirds& outer, const Thirds& middle, uint8_t* to) {
  std::array<v_uint16x8, 3> low, high;
  for (size_t k = 0; k < 3; ++k) {
    low[k] = outer.low[k] + outer.low[k] + middle.low[k];
    high[k] = outer.high[k] + outer.high[k] + middle.high[k];
  }
  const v_uint8x16 left = ninth(low[0] + low[0] + low[1], high[0] + high[0] + high[1]);
  const v_uint8x16 right = ninth(low[2] + low[2] + low[1], high[2] + high[2] + high[1]);
  cv::v_store_interleave(to, left, right);
}

/// Reduces three rows of the image to two. The last vectors are stored partly in the padding, which
/// repeat_border() overwrites.
void reduce_rows(const uint8_t* const rows[3], int width, uint8_t* upper, uint8_t* lower) {
  static_assert(PaddedImage::kPad_px >= 32, "a vector ends within the padding");
  for (int x = 0; x < width; x += 32) {
    const int from = x / 2 * 3;
    const Thirds middle(rows[1] + from);
    store_pairs(Thirds(rows[0] + from), middle, upper + x);
    if (lower) store_pairs(Thirds(rows[2] + from), middle, lower + x);
  }
}

/// If compensation leaves more than this fraction of the difference, the improvement may be chance.
/// In a pan, most of the difference is motion, whatever the light does.
constexpr double kMaxRemaining = 0.9;

/// Whether `table`, applied to `before`, clearly reduces the difference from `now`.
bool reduces_difference(const PaddedImage& before, const PaddedImage& now,
                        const std::array<uint8_t, 256>& table) {
  int64_t difference = 0;
  int64_t remaining = 0;
  for (int y = 0; y < now.height(); ++y) {
    const uint8_t* p = before.row(y);
    const uint8_t* q = now.row(y);
    for (int x = 0; x < now.width(); ++x) {
      difference += std::abs(q[x] - p[x]);
      remaining += std::abs(q[x] - table[p[x]]);
    }
  }
  return static_cast<double>(remaining) < kMaxRemaining * static_cast<double>(difference);
}

void replace_values(const std::array<uint8_t, 256>& table, PaddedImage& picture) {
  for (int y = 0; y < picture.height(); ++y) {
    uint8_t* row = picture.row(y);
    for (int x = 0; x < picture.width(); ++x) row[x] = table[row[x]];
  }
  picture.repeat_border();
}

}  // namespace

FieldScale field_scale(int base_width, int base_height) {
  FieldScale best = FieldScale::kSame;
  double least = 1e300;
  for (const FieldScale scale : {FieldScale::kSame, FieldScale::kTwoThirds, FieldScale::kHalf}) {
    const double side = 1 / pixels_to_one(scale);
    if (side * std::min(base_width, base_height) < kMinSide_px) continue;
    const double area_px2 = side * side * base_width * base_height;
    const double distance = std::abs(std::log(area_px2 / kFieldArea_px2));
    if (distance < least) {
      least = distance;
      best = scale;
    }
  }
  return best;
}

double pixels_to_one(FieldScale scale) {
  switch (scale) {
    case FieldScale::kSame:
      return 1;
    case FieldScale::kTwoThirds:
      return 1.5;
    case FieldScale::kHalf:
      return 2;
  }
  return 1;
}

void reduce_to_field(const PaddedImage& base, FieldScale scale, PaddedImage& picture) {
  switch (scale) {
    case FieldScale::kSame:
      picture.resize(base.width(), base.height());
      for (int y = 0; y < base.height(); ++y) {
        std::memcpy(picture.row(y), base.row(y), static_cast<size_t>(base.width()));
      }
      break;
    case FieldScale::kTwoThirds:
      reduce_to_two_thirds(base, picture);
      break;
    case FieldScale::kHalf:
      halve(base, picture);
      break;
  }
  picture.repeat_border();
}

void reduce_to_two_thirds(const PaddedImage& image, PaddedImage& reduced) {
  reduced.resize(image.width() * 2 / 3, image.height() * 2 / 3);
  for (int y = 0; y < reduced.height(); y += 2) {
    const int from = y / 2 * 3;
    const bool has_lower = y + 1 < reduced.height();
    const uint8_t* const rows[3] = {image.row(from), image.row(from + 1),
                                    image.row(has_lower ? from + 2 : from + 1)};
    reduce_rows(rows, reduced.width(), reduced.row(y), has_lower ? reduced.row(y + 1) : nullptr);
  }
}

void compensate_light(PaddedImage& coarse_before, const PaddedImage& coarse_now,
                      PaddedImage& before) {
  cv::Scalar mean_before, mean_now, sigma_before, sigma_now;
  cv::meanStdDev(const_mat(coarse_before.view()), mean_before, sigma_before);
  cv::meanStdDev(const_mat(coarse_now.view()), mean_now, sigma_now);
  // Contrast below one grey level is mostly rounding error.
  const bool has_contrast = sigma_before[0] >= 1 && sigma_now[0] >= 1;
  const double gain = has_contrast ? sigma_now[0] / sigma_before[0] : 1;
  std::array<uint8_t, 256> table;
  for (size_t v = 0; v < table.size(); ++v) {
    const double value = gain * (static_cast<double>(v) - mean_before[0]) + mean_now[0];
    table[v] = static_cast<uint8_t>(std::clamp(value + 0.5, 0.0, 255.0));
  }
  if (!reduces_difference(coarse_before, coarse_now, table)) return;
  replace_values(table, coarse_before);
  replace_values(table, before);
}

namespace {

using Eigen::Vector2f;
using Eigen::Vector2i;

/// The contrast of a block is its difference from its own mean. If the difference from the best
/// match exceeds this fraction of the contrast, the match shows something else, and the block is
/// lost.
constexpr double kFoundElsewhere = 0.5;
/// The fraction of the textured blocks that are lost at a cut.
constexpr double kLostAtCut = 0.8;
/// The fraction of the textured blocks that are found again even where noise hides most others.
constexpr double kBestFraction = 0.02;
/// The largest mean absolute difference attributed to noise (σ = 5.3). With 8, two different parts
/// of a uniform synthetic texture would pass for the same part with noise.
constexpr int kMaxNoise_grey = 6;

double squared(double value) {
  return value * value;
}

bool is_finite_motion(const Vector2f& moved_px) {
  constexpr float kMax_px = 4096;
  return std::abs(moved_px.x()) < kMax_px && std::abs(moved_px.y()) < kMax_px;
}

/// A position between pixels.
struct Position {
  Vector2i pixel;
  Vector2i fraction;  ///< in units of kFractionOne

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

/// Starts a shot from the current picture alone. Because nothing from before the cut remains, the
/// result after a cut does not depend on where the analysis began.
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
  pictures_back_ = std::min(pictures_back_ + 1, kMaxBack);
  stands_still_ = false;
  return Result::kMoved;
}

void BlockField::measure_noise() {
  residuals_.clear();
  for (const MotionBlock& block : blocks_) residuals_.push_back(block.residual);
  noise_grey2_ = quantile(residuals_, 1 / 3.0);
}

/// After a cut, the best matches are doubtful on average, and nearly all textured blocks are lost.
/// In a moving picture, however fast it moves, some blocks still match. The difference of the best
/// ones counts as noise, up to kMaxNoise_grey. A difference contains the noise of two pictures, but
/// a contrast contains that of one.
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
  const double noise2 = std::min(best->difference2, squared(kMaxNoise_grey * kBlockArea_px));
  const auto is_lost = [&](const Textured& block) {
    return block.difference2 - noise2 > squared(kFoundElsewhere) * (block.contrast2 - noise2 / 2);
  };
  const auto lost = std::count_if(textured_.begin(), textured_.end(), is_lost);
  return static_cast<double>(lost) > kLostAtCut * count;
}

int BlockField::contrast_of(size_t block) const {
  return difference_from_mean(pixels_at(now_, grid_.corner_of(block)));
}

BlockField::Match BlockField::match_of(size_t block) const {
  const int contrast = contrast_of(block);
  if (contrast < kDoubtful_grey * kBlockArea_px) return Match::kPlain;
  return matches_[block].difference > kFoundElsewhere * contrast ? Match::kLost : Match::kFound;
}

/// Searches at a quarter of the resolution, where each block covers 4 × 4 blocks of the full
/// resolution and is searched over the whole range: this finds objects that moved far.
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

void BlockField::set_still() {
  stands_still_ = true;
  for (BlockMatch& match : matches_) match = BlockMatch();
  for (MotionBlock& block : blocks_) {
    block.moved_px.setZero();
    block.residual = 0;
    block.difference = 0;
  }
  noise_grey2_ = 0;
}

/// Whether blocks with a corner between `corner_px` and the next pixel in x and y are within reach.
bool BlockField::is_in_reach(const Vector2i& corner_px) const {
  const Vector2i last_px(now_.width() - kBlock_px - 1, now_.height() - kBlock_px - 1);
  return (corner_px.array() >= -kBlockReach_px).all() &&
         ((corner_px - last_px).array() <= kBlockReach_px).all();
}

size_t BlockField::origin_of(size_t index) const {
  const Vector2f& moved_px = blocks_[index].moved_px;
  const auto back = [](int position, float by_px, int count) {
    // Clamping first keeps the value ≥ 0, so that adding 0.5 rounds it: std::lround() would
    // cost a function call, three times per block.
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
  int least = kBlockArea_px * 256;
  // With a zero fraction, this equals the first position of the loop below.
  if (!from.fraction.isZero()) {
    least = bilinear_difference(here, pixels_at(before(), from.pixel), from.fraction.x(),
                                from.fraction.y());
  }
  for (const Vector2i& next : {Vector2i(0, 0), Vector2i(1, 0), Vector2i(0, 1), Vector2i(1, 1)}) {
    const BlockPixels there = pixels_at(before(), from.pixel + next);
    least = std::min(least, block_difference(here, there, least));
  }
  return least;
}

std::optional<int> BlockField::cell_difference_gain(size_t block, int back,
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
