// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/motion/layers/moving_blocks.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/LU>

#include "core/motion/camera/motion_models.h"
#include "core/quantile.h"

namespace spidar {
namespace {

/// The direction in which most blocks move. A block that moves little has little weight, and a
/// block that moves far has no more than any other.
Eigen::Vector2f direction_of(const std::vector<Eigen::Vector2f>& moved_px, float middle_px2) {
  float unequal = 0;
  float mixed = 0;
  for (const Eigen::Vector2f& px : moved_px) {
    const float size_px2 = px.squaredNorm() + middle_px2;
    if (size_px2 == 0) continue;
    unequal += (px.x() * px.x() - px.y() * px.y()) / size_px2;
    mixed += 2 * px.x() * px.y() / size_px2;
  }
  const float angle_rad = std::atan2(mixed, unequal) / 2;
  return {std::cos(angle_rad), std::sin(angle_rad)};
}

/// The number of pixels of a block whose errors are independent, of 256: coding and interpolation
/// change neighbours alike.
constexpr float kIndependentPixels = 16;
/// The variance of a block's mean difference that remains when the block's own motion explains
/// every pixel, grey². It is due to rounding, and to light that changes a little from position to
/// position.
constexpr float kMinVariance_grey2 = 0.5f;

/// The squared Mahalanobis distance from which on a block moves by itself. The distance of two
/// Gaussian coordinates exceeds it in e^(−13/2) = 0.15 % of the blocks.
constexpr float kMinDistance2 = 13;
/// Motions that are further apart than this, px of the field's picture, differ in whole pixels,
/// because each is right to kMaxOff_px. Pixel differences do not separate motions that are closer.
constexpr float kDifferentPixels_px = 2 * kMaxOff_px;
/// The factor on the covariance of the parallax for a slow block. Depths are not normally
/// distributed: much of a scene is further from the model than the median suggests.
constexpr float kDepths = 4;
/// A known object may become slower by this factor before it counts as resting. Otherwise the
/// object would stop as soon as it falls below the threshold, and only the faster limbs of a body
/// would remain.
constexpr float kSlower = 0.6f;
/// How much worse the background's motion must explain the pixels than the block's own motion: by
/// kRounding_grey, a fraction of the picture's noise, and a fraction of the difference that the
/// block's own motion leaves.
constexpr float kWorseByNoise = 0.3f;
constexpr float kWorseFraction = 0.15f;
/// The same, as a mean per pixel, for a block without texture where no object is known: both
/// differences may contain noise and coding errors.
constexpr int kFarWorse_grey = 2 * kDoubtful_grey;

/// A block that stands out moves if this many around it stand out, too: errors are seldom adjacent.
constexpr int kMinNeighbours = 3;

/// How much a block must have stood out in the last frames, 0 … 1, see store_stood_out(): a block
/// that stood out in two of them needs only one moving neighbour, and in four of them none.
constexpr float kLastingBesideOne = 0.5f;
constexpr float kLastingAlone = 0.8f;

/// Squared Mahalanobis distance eᵀ C⁻¹ e of a block's motion e from the background's. The
/// covariance is C = v S⁻¹ + N, where v S⁻¹ is that of the error of the block's motion, with S the
/// structure tensor of the block, and N, `noise_px2`, that of blocks that follow the background. An
/// edge has an S without an inverse, so the computation uses the inverse of C S = v 1 + N S.
float distance2(const RelativeBlock& relative, const MotionBlock& block,
                const Eigen::Matrix2f& noise_px2) {
  const float v = block.residual / kIndependentPixels + kMinVariance_grey2;
  const Eigen::Matrix2f both = v * Eigen::Matrix2f::Identity() + noise_px2 * block.structure;
  return (block.structure * relative.moved_px).dot(both.inverse() * relative.moved_px);
}

bool moves_slowly(const RelativeBlock& relative) {
  return std::hypot(relative.moved_px.x(), relative.moved_px.y()) <= kDifferentPixels_px;
}

/// How much worse the background's motion explains a block's pixels than the block's own motion
/// does, Σ |now − before|; nothing if the background's motion leads too far out of the picture.
std::optional<int> worse_with_background(const BlockField& field, size_t index,
                                         const RelativeBlock& relative) {
  const int with_background = field.difference_if_moved(index, relative.background_px);
  if (with_background < 0) return std::nullopt;
  return with_background - field.blocks()[index].difference;
}

/// The least worse_with_background() of a fast block that moves by itself.
float least_worse(const BlockField& field, const MotionBlock& block) {
  return kBlockArea_px * (kRounding_grey + kWorseByNoise * std::sqrt(field.noise_grey2())) +
         kWorseFraction * static_cast<float>(block.difference);
}

/// Whether the pixels of a block separate its motion from the background's without any texture.
bool pixels_show_motion(const BlockField& field, size_t index, const RelativeBlock& relative,
                        bool expected) {
  // Both motions are accurate to half a pixel.
  if (std::hypot(relative.moved_px.x(), relative.moved_px.y()) < kMaxOff_px / 2) return false;
  const float least =
      expected ? least_worse(field, field.blocks()[index]) : kFarWorse_grey * kBlockArea_px;
  const std::optional<int> worse = worse_with_background(field, index, relative);
  return worse && static_cast<float>(*worse) > least;
}

bool is_expected(const std::vector<uint8_t>& expected, size_t index) {
  return index < expected.size() && expected[index] != 0;
}

/// A block cannot be compared with the previous picture if less than this fraction of the block was
/// in that picture.
constexpr double kSeenBefore = 0.5;

/// The fraction of a block that was in the previous picture if the block moved with the background.
float seen_before(const BlockField& field, size_t index, const RelativeBlock& block) {
  const Eigen::Vector2f size_px(static_cast<float>(field.picture().width()),
                                static_cast<float>(field.picture().height()));
  const Eigen::Vector2f low_px = field.grid().corner_of(index).cast<float>() - block.background_px;
  const Eigen::Vector2f high_px = (low_px.array() + kBlock_px).matrix().cwiseMin(size_px);
  return (high_px - low_px.cwiseMax(0)).cwiseMax(0).prod() / kBlockArea_px;
}

}  // namespace

/// Medians are used because some blocks move by themselves.
void Parallax::measure(const std::vector<Eigen::Vector2f>& moved_px) {
  covariance_px2_.setZero();
  if (moved_px.empty()) return;
  sizes_.reserve(moved_px.capacity());
  sizes_.clear();
  for (const Eigen::Vector2f& px : moved_px) sizes_.push_back(px.squaredNorm());
  const Eigen::Vector2f along = direction_of(moved_px, median(sizes_.begin(), sizes_.end()));
  for (const Eigen::Vector2f& axis : {along, Eigen::Vector2f(-along.y(), along.x())}) {
    for (size_t i = 0; i < moved_px.size(); ++i) sizes_[i] = std::abs(axis.dot(moved_px[i]));
    const double middle_px = static_cast<double>(median(sizes_.begin(), sizes_.end()));
    const auto sigma_px = static_cast<float>(std::max(middle_px / kNormalMedian, kSharedError_px));
    covariance_px2_ += sigma_px * sigma_px * axis * axis.transpose();
  }
}

double Parallax::sigma_px(const Eigen::Vector2d& motion) const {
  const Eigen::Matrix2d covariance_px2 = covariance_px2_.cast<double>();
  if (!(covariance_px2.determinant() > 0) || motion.isZero()) return 0;
  const Eigen::Vector2d direction = motion.normalized();
  return 1 / std::sqrt(direction.dot(covariance_px2.inverse() * direction));
}

double alike_px(double fastest_px) {
  return kAlikeFraction * fastest_px + 3 * kUsualNoise_px;
}

bool are_alike(const Eigen::Vector2f& a_px, const Eigen::Vector2f& b_px) {
  const float fastest_px2 = std::max(a_px.squaredNorm(), b_px.squaredNorm());
  const auto most_px = static_cast<float>(alike_px(static_cast<double>(std::sqrt(fastest_px2))));
  return (a_px - b_px).squaredNorm() < most_px * most_px;
}

void MovingBlocks::reset() {
  foreground_.clear();
  stood_out_.clear();
  burned_in_.reset();
}

/// Computes the motion of each block relative to the background.
void MovingBlocks::compare(const BlockField& field, const Background& background,
                           const std::vector<uint8_t>& expected) {
  const std::vector<MotionBlock>& blocks = field.blocks();
  relative_.resize(blocks.size());
  for (size_t i = 0; i < blocks.size(); ++i) {
    const MotionBlock& block = blocks[i];
    const Eigen::Vector2d at_px = block.centre_px.cast<double>();
    // The model maps from the previous picture; it hardly differs between the two positions.
    const Eigen::Vector2d there_px = at_px - background.model.displacement_px(at_px);
    RelativeBlock& relative = relative_[i];
    relative.background_px = background.model.displacement_px(there_px).cast<float>();
    relative.moved_px = block.moved_px - relative.background_px;
    relative.shows_motion =
        block.has_texture() || pixels_show_motion(field, i, relative, is_expected(expected, i));
    // If less of the block was in the picture before, the camera has just brought it into view.
    relative.was_outside = static_cast<double>(seen_before(field, i, relative)) < kSeenBefore;
  }
}

/// Uses the blocks whose motion is known in every direction.
void MovingBlocks::measure_parallax(const BlockField& field) {
  of_scene_px_.reserve(relative_.size());
  of_scene_px_.clear();
  for (size_t i = 0; i < relative_.size(); ++i) {
    const RelativeBlock& block = relative_[i];
    if (block.was_outside || burned_in_.contains(i)) continue;
    if (field.blocks()[i].has_corners()) of_scene_px_.push_back(block.moved_px);
  }
  parallax_.measure(of_scene_px_);
}

bool MovingBlocks::stands_out(const BlockField& field, size_t index,
                              const Eigen::Matrix2f& noise_px2, bool expected) const {
  const MotionBlock& block = field.blocks()[index];
  const RelativeBlock& relative = relative_[index];
  if (!relative.shows_motion) return false;
  const float least2 = expected ? kSlower * kSlower * kMinDistance2 : kMinDistance2;
  if (distance2(relative, block, noise_px2) < least2) return false;
  if (relative.was_outside) return false;
  // The pixels of a slow block prove nothing, and in a scene with depth, a moving camera moves many
  // blocks a little.
  const bool is_slow = moves_slowly(relative);
  if (is_slow) {
    if (expected || camera_is_still_) return true;
    const Eigen::Matrix2f depths_px2 = kDepths * parallax_.covariance_px2();
    if (distance2(relative, block, depths_px2) < kMinDistance2) return false;
  }
  const std::optional<int> worse = worse_with_background(field, index, relative);
  if (!worse) return false;
  return static_cast<float>(*worse) >= (expected || is_slow ? 0 : least_worse(field, block));
}

void MovingBlocks::exclude_burned_in(const BlockField& field,
                                     const std::vector<uint8_t>& expected) {
  burned_in_.begin(field, !camera_is_still_);
  for (size_t i = 0; i < stands_out_.size(); ++i) {
    if (stands_out_[i] == 0) continue;
    burned_in_.classify(field, {i, relative_[i].background_px, moves_slowly(relative_[i]),
                                is_expected(expected, i)});
  }
  burned_in_.end(field.grid());
  for (size_t i = 0; i < stands_out_.size(); ++i) {
    if (burned_in_.contains(i)) stands_out_[i] = 0;
    relative_[i].is_occluded = burned_in_.occludes(i);
    relative_[i].was_outside |= burned_in_.margins().contains(field.grid(), i);
  }
}

void MovingBlocks::confirm_with_neighbours(const BlockGrid& grid) {
  for (size_t i = 0; i < relative_.size(); ++i) {
    RelativeBlock& block = relative_[i];
    block.lasts = block.moves = false;
    if (stands_out_[i] == 0) continue;
    int moving = -1;  // the block itself does not count
    grid.each_around(i, 1, [&](size_t other) { moving += stands_out_[other]; });
    const float lately = stood_out_[i].fraction;
    block.lasts = lately > kLastingAlone;
    block.moves =
        block.lasts || moving >= kMinNeighbours || (moving > 0 && lately > kLastingBesideOne);
  }
}

/// Updates how often each block has recently stood out with the same motion, because glitter stands
/// out with another motion each time. A small object may have moved on to the next block.
void MovingBlocks::store_stood_out(const BlockField& field) {
  const size_t n = stands_out_.size();
  stood_out_before_.swap(stood_out_);
  if (stood_out_before_.size() != n) stood_out_before_.assign(n, {});
  stood_out_.resize(n);
  for (size_t i = 0; i < n; ++i) {
    const size_t origin = field.origin_of(i);
    StoodOut before = stood_out_before_[origin];
    field.grid().each_beside(origin, [&](size_t beside) {
      if (stood_out_before_[beside].fraction > before.fraction) before = stood_out_before_[beside];
    });
    const Eigen::Vector2f& moved_px = relative_[i].moved_px;
    const bool goes_on = before.fraction == 0 || are_alike(moved_px, before.moved_px);
    const float now = stands_out_[i] != 0 && goes_on ? 1.0f : 0.0f;
    stood_out_[i] = {before.fraction + static_cast<float>(kNewestWeight) * (now - before.fraction),
                     moved_px};
  }
}

void MovingBlocks::remember_motion(const BlockField& field) {
  const size_t n = relative_.size();
  foreground_before_.swap(foreground_);
  if (foreground_before_.size() != n) foreground_before_.assign(n, 0);
  foreground_.resize(n);
  for (size_t i = 0; i < n; ++i) {
    const float before = foreground_before_[field.origin_of(i)];
    const float now = relative_[i].moves ? 1.0f : 0.0f;
    foreground_[i] = before + static_cast<float>(kNewestWeight) * (now - before);
  }
}

const std::vector<RelativeBlock>& MovingBlocks::find(const BlockField& field,
                                                     const Background& background,
                                                     const std::vector<uint8_t>& expected) {
  compare(field, background, expected);
  camera_is_still_ = background.model.kind == ModelKind::kStill;
  if (!camera_is_still_) measure_parallax(field);
  const auto noise_px = static_cast<float>(background.sigma_px);
  const Eigen::Matrix2f noise_px2 = noise_px * noise_px * Eigen::Matrix2f::Identity();
  stands_out_.resize(relative_.size());
  for (size_t i = 0; i < stands_out_.size(); ++i) {
    stands_out_[i] = stands_out(field, i, noise_px2, is_expected(expected, i));
  }
  exclude_burned_in(field, expected);
  store_stood_out(field);
  confirm_with_neighbours(field.grid());
  if (!background.is_known) {
    for (RelativeBlock& block : relative_) block.moves = false;
  }
  remember_motion(field);
  return relative_;
}

}  // namespace spidar
