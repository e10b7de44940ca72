// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/motion/learned/block_features.h"

#include <algorithm>
#include <cmath>

#include "core/motion/learned/feature_scales.h"

namespace spidar {
namespace {

/// Squared Mahalanobis distance from the background from which on the pixels are asked. Nearer
/// blocks would answer with noise.
constexpr float kAskPixels2 = 4;
/// A block without texture tells little of its motion; its pixels are asked from here on.
constexpr float kAskPlain_px = 0.5f;
/// Half weight of a block: of its texture, (grey / px)², and of its residual, grey².
constexpr float kHalfTexture = 24;
constexpr float kHalfResidual = 60;
/// The blocks around a block: this many on each side.
constexpr int kAround = 2;
/// Pairs of pictures of which a mean motion remembers.
constexpr float kMostPairs = 6;
/// Motions are at most as long as a picture of the field.
constexpr float kMostMotion_px = 1000;

float finite(float px) {
  return px > -kMostMotion_px && px < kMostMotion_px ? px : 0;
}

/// Inverse covariance of the motion of a block with the structure tensor S and errors of the
/// variance v: (v S⁻¹ + N)⁻¹ = S (v 1 + N S)⁻¹, which is finite for edges, too.
class Information {
 public:
  Information(const MotionBlock& block, float nxx, float nxy, float nyy) {
    const float v = variance_grey2(block);
    const float a = v + nxx * block.xx + nxy * block.xy;
    const float b = nxx * block.xy + nxy * block.yy;
    const float c = nxy * block.xx + nyy * block.xy;
    const float d = v + nxy * block.xy + nyy * block.yy;
    const float one_by = 1 / (a * d - b * c);
    xx_ = one_by * (block.xx * d - block.xy * c);
    xy_ = one_by * (block.xy * a - block.xx * b);
    yy_ = one_by * (block.yy * a - block.xy * b);
  }

  /// Squared Mahalanobis distance of e from no motion.
  float distance2(const Eigen::Vector2f& e) const {
    const float sum = e.x() * (xx_ * e.x() + 2 * xy_ * e.y()) + e.y() * e.y() * yy_;
    return std::max(0.0f, sum);
  }
  /// The same from any motion along a unit vector: (n·e)² / (nᵀ C n), where n is across it.
  float distance2_across(const Eigen::Vector2f& e, const Eigen::Vector2f& along) const {
    constexpr float kLeast = 1e-9f;
    const float across_px = along.x() * e.y() - along.y() * e.x();
    const float determinant = std::max(0.0f, xx_ * yy_ - xy_ * xy_);
    return across_px * across_px * determinant / (distance2(along) + kLeast);
  }

 private:
  float xx_;
  float xy_;
  float yy_;
};

float weight_of(const MotionBlock& block) {
  const float texture = block.xx + block.yy;
  return texture / (texture + kHalfTexture) / (1 + block.residual / kHalfResidual);
}

/// How much better a block's own motion explains its pixels, Σ |now − before|.
struct PixelsSay {
  float better_than_background = 0;
  float better_than_rest = 0;
  StayingPixels staying;

  PixelsSay(const BlockField& field, size_t index, const RelativeBlock& relative, bool is_still) {
    const auto block = static_cast<int>(index);
    const int own = field.blocks()[index].difference;
    const float x_px = relative.background_x_px;
    const float y_px = relative.background_y_px;
    const int with_background = std::max(0, field.difference_if_moved(block, x_px, y_px));
    better_than_background = static_cast<float>(with_background - own);
    better_than_rest = static_cast<float>(field.difference_if_moved(block, 0, 0) - own);
    if (!is_still) staying = field.staying_pixels(block, x_px, y_px);
  }
  PixelsSay() = default;
};

/// The ellipse of the parallax.
struct ParallaxAxes {
  float major_px;
  float minor_px;
  float angle_rad;

  explicit ParallaxAxes(const Eigen::Matrix2f& px2) {
    constexpr float kLeast_px2 = 1e-4f;
    const float a = px2(0, 0);
    const float b = px2(1, 1);
    const float c = px2(0, 1);
    const float root = std::hypot(a - b, 2 * c);
    major_px = std::sqrt(std::max(kLeast_px2, (a + b + root) / 2));
    minor_px = std::sqrt(std::max(kLeast_px2, (a + b - root) / 2));
    angle_rad = std::atan2(2 * c, a - b) / 2;
  }
};

}  // namespace

void BlockFeatures::reset() {
  content_.clear();
}

/// Averages the motion of the content of each block, which moves along with the picture.
void BlockFeatures::follow(const BlockField& field, const std::vector<RelativeBlock>& relative) {
  const size_t n = relative.size();
  content_before_.swap(content_);
  if (content_before_.size() != n) content_before_.assign(n, {});
  content_.resize(n);
  origins_.resize(n);
  for (size_t i = 0; i < n; ++i) {
    const size_t origin = field.origin_of(i);
    origins_[i] = static_cast<uint32_t>(origin);
    Content content = content_before_[origin];
    // Less than half a doubtful difference is none between a lost block and its match.
    const bool may_be_lost = field.blocks()[i].difference > kDoubtful_grey * kBlockArea_px / 2;
    const bool is_new =
        relative[i].was_outside || (may_be_lost && field.match_of(i) == BlockField::Match::kLost);
    content.pairs = is_new ? 1 : std::min(content.pairs + 1, kMostPairs);
    content.moved_px = {finite(relative[i].x_px), finite(relative[i].y_px)};
    if (is_new) content.mean_px = content.moved_px;
    content.mean_px += (content.moved_px - content.mean_px) / content.pairs;
    content_[i] = content;
  }
}

/// Sums the motions of the blocks around each block, weighted by their texture.
void BlockFeatures::look_around(const BlockField& field) {
  const BlockGrid& grid = field.grid();
  const size_t n = content_.size();
  own_.resize(n);
  in_row_.resize(n);
  around_.resize(n);
  for (size_t i = 0; i < n; ++i) {
    const float weight = weight_of(field.blocks()[i]);
    own_[i] = {weight * content_[i].moved_px, weight};
  }
  const auto sum = [](const std::vector<Weighted>& of, int from, int to, int step) {
    Weighted all;
    for (int k = from; k <= to; k += step) {
      const Weighted& one = of[static_cast<size_t>(k)];
      all.sum_px += one.sum_px;
      all.weight += one.weight;
    }
    return all;
  };
  const int columns = grid.columns;
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const int first = row * columns;
      in_row_[static_cast<size_t>(first + column)] =
          sum(own_, first + std::max(column - kAround, 0),
              first + std::min(column + kAround, columns - 1), 1);
    }
  }
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      around_[static_cast<size_t>(row * columns + column)] =
          sum(in_row_, std::max(row - kAround, 0) * columns + column,
              std::min(row + kAround, grid.rows - 1) * columns + column, columns);
    }
  }
}

void BlockFeatures::find_epipole(const BlockField& field, const Background& background,
                                 const std::vector<RelativeBlock>& relative) {
  const float one_by_half_width = 2 / static_cast<float>(field.picture().width());
  of_scene_.reserve(relative.size());
  of_scene_.clear();
  for (size_t i = 0; i < relative.size(); ++i) {
    const MotionBlock& block = field.blocks()[i];
    if (relative[i].was_outside || block.weakest_texture() < MotionBlock::kLeastTexture) continue;
    of_scene_.push_back({one_by_half_width * Eigen::Vector2f(block.x_px, block.y_px),
                         content_[i].moved_px, own_[i].weight});
  }
  epipole_.find(of_scene_, static_cast<float>(background.sigma_px));
}

void BlockFeatures::measure(const BlockField& field, const Background& background,
                            const std::vector<RelativeBlock>& relative,
                            const Eigen::Matrix2f& parallax_px2) {
  const std::vector<MotionBlock>& blocks = field.blocks();
  const BlockGrid& grid = field.grid();
  const size_t n = blocks.size();
  values_.resize(n * kFeatures);
  follow(field, relative);
  look_around(field);
  find_epipole(field, background, relative);

  const auto sigma_px = static_cast<float>(background.sigma_px);
  const float noise_px2 = sigma_px * sigma_px;
  const ParallaxAxes parallax(parallax_px2);
  const Eigen::Vector2f along(std::cos(parallax.angle_rad), std::sin(parallax.angle_rad));
  const float oblong = 1 - parallax.minor_px / parallax.major_px;
  const float oblong_x = oblong * std::cos(2 * parallax.angle_rad);
  const float oblong_y = oblong * std::sin(2 * parallax.angle_rad);
  const bool is_still = background.model.kind == ModelKind::kStill;
  const float one_by_half_width = 2 / static_cast<float>(field.picture().width());
  const float log_sigma = std::log(sigma_px / 0.1f) / 2;
  const float log_major = std::log(parallax.major_px / 0.1f) / 3;
  const float log_minor = std::log(parallax.minor_px / 0.1f) / 3;
  const float noise_grey2 = field.noise_grey2();

  for (size_t i = 0; i < n; ++i) {
    const int row = static_cast<int>(i) / grid.columns;
    const int column = static_cast<int>(i) % grid.columns;
    const MotionBlock& block = blocks[i];
    const RelativeBlock& r = relative[i];
    const Eigen::Vector2f& e = content_[i].moved_px;
    const Eigen::Vector2f& mean = content_[i].mean_px;
    const Eigen::Vector2f moved(block.moved_x_px, block.moved_y_px);
    const float around_weight = around_[i].weight - own_[i].weight + 1e-3f;
    const Eigen::Vector2f around = (around_[i].sum_px - own_[i].sum_px) / around_weight;
    const Eigen::Vector2f before = content_before_[origins_[i]].moved_px;
    const float texture = block.xx + block.yy;
    const float weakest = block.weakest_texture();
    const Information information(block, noise_px2, 0, noise_px2);
    const Information in_parallax(block, parallax_px2(0, 0), parallax_px2(0, 1),
                                  parallax_px2(1, 1));
    const Information alone(block, 0, 0, 0);
    const float d2 = information.distance2(e);
    const bool ask = d2 > kAskPixels2 || (weakest < MotionBlock::kLeastTexture &&
                                          e.squaredNorm() > kAskPlain_px * kAskPlain_px);
    const PixelsSay pixels = ask ? PixelsSay(field, i, r, is_still) : PixelsSay();

    float* f = &values_[i * kFeatures];
    // 0: motion relative to the background, its own, and the background's
    *f++ = e.x();
    *f++ = e.y();
    *f++ = moved.x();
    *f++ = moved.y();
    *f++ = finite(r.background_x_px);
    *f++ = finite(r.background_y_px);
    // 6: distances from the background, from the scene with its depth, and from rest
    *f++ = std::sqrt(d2);
    *f++ = std::sqrt(in_parallax.distance2(e));
    *f++ = std::sqrt(alone.distance2(moved));
    // 9: texture, its direction, and what the block's motion leaves unexplained
    *f++ = weakest;
    *f++ = texture;
    *f++ = (block.xx - block.yy) / (texture + 1);
    *f++ = 2 * block.xy / (texture + 1);
    *f++ = block.residual;
    *f++ = std::log((1 + block.residual) / (1 + noise_grey2)) / 5;
    // 15: what its pixels say
    *f++ = pixels.better_than_background / kBlockArea_px;
    *f++ = pixels.better_than_rest / kBlockArea_px;
    *f++ = static_cast<float>(block.difference) / kBlockArea_px;
    *f++ = static_cast<float>(pixels.staying.near) / kBlockArea_px;
    *f++ = static_cast<float>(pixels.staying.exact) / kBlockArea_px;
    // 20: its place
    *f++ = r.was_outside;
    *f++ = 2 * (static_cast<float>(column) + 0.5f) / static_cast<float>(grid.columns) - 1;
    *f++ = 2 * (static_cast<float>(row) + 0.5f) / static_cast<float>(grid.rows) - 1;
    *f++ = static_cast<float>(
               std::min({column, row, grid.columns - 1 - column, grid.rows - 1 - row, 4})) /
           4;
    // 24: distances from the blocks around and from the pair of pictures before
    *f++ = std::sqrt(information.distance2(e - around));
    *f++ = std::sqrt(information.distance2(e - before));
    *f++ = std::abs(along.dot(e)) / parallax.major_px;
    *f++ = std::abs(along.x() * e.y() - along.y() * e.x()) / parallax.minor_px;
    // 28: the whole picture
    *f++ = is_still;
    *f++ = static_cast<float>(background.coverage);
    *f++ = log_sigma;
    *f++ = log_major;
    *f++ = log_minor;
    *f++ = oblong_x;
    *f++ = oblong_y;
    *f++ = background.is_known;
    // 36: its mean motion relative to the background
    *f++ = mean.x();
    *f++ = mean.y();
    *f++ = std::sqrt(content_[i].pairs * information.distance2(mean));
    *f++ = (content_[i].pairs - 1) / (kMostPairs - 1);
    // 40: along and across the direction in which depth moves a still scene
    if (epipole_.is_known()) {
      const Eigen::Vector2f towards =
          epipole_.direction(one_by_half_width * Eigen::Vector2f(block.x_px, block.y_px));
      *f++ = std::sqrt(information.distance2_across(e, towards));
      *f++ = towards.dot(e);
      *f++ = epipole_.agreeing();
      *f++ = epipole_.moving();
    } else {
      std::fill_n(f, 4, 0.0f);
    }
  }
  scale_features(values_.data(), n);
}

}  // namespace spidar
