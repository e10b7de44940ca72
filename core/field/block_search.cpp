// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/field/block_search.h"

#include <array>
#include <cstdlib>
#include <limits>
#include <optional>

#include <Eigen/LU>

namespace spidar {
namespace {

/// The cost of each pixel by which a match deviates from the median of its neighbours: an eighth of
/// a grey level per pixel of the block. Beyond half a block, the cost stays the same.
constexpr int kLambda = kBlockArea_px / 8;
constexpr int kMaxDeviation_px = kBlock_px / 2;
/// If no candidate fits, the search is widened: in steps of a block, halved down to a quarter.
constexpr int kFarthest_px = kBlock_px;
constexpr int kNearest_px = kBlock_px / 4;
/// A walk goes as far as the cost of a deviation rises.
constexpr int kMostSteps = kMaxDeviation_px;

using Eigen::Vector2i;

/// The median of each coordinate.
Vector2i middle(const Vector2i& a, const Vector2i& b, const Vector2i& c) {
  return a.cwiseMin(b).cwiseMax(a.cwiseMax(b).cwiseMin(c));
}

class Walk {
 public:
  Walk(const PaddedImage& before, const PaddedImage& now, const Vector2i& at_px)
      : before_(before),
        block_{now.row(at_px.y()) + at_px.x(), now.stride()},
        origin_(before.row(at_px.y()) + at_px.x()),
        low_(Vector2i::Constant(-kBlockReach_px) - at_px),
        high_(Vector2i(before.width(), before.height()) +
              Vector2i::Constant(kBlockReach_px - kBlock_px) - at_px) {}

  void expect(const Vector2i& expected) { expected_ = expected; }

  /// Adds a vector unless it is already a candidate.
  void add_candidate(const Vector2i& candidate) {
    const Vector2i v = inside(candidate);
    const auto end = candidates_.begin() + count_;
    if (std::find(candidates_.begin(), end, v) == end) {
      candidates_[static_cast<size_t>(count_++)] = v;
    }
  }

  void try_candidates() {
    for (int i = 0; i < count_; ++i) try_at(candidates_[static_cast<size_t>(i)]);
  }

  void try_hint(const Vector2i& hint) { try_at(inside(hint)); }

  /// Tries every second pixel around rest; for the few blocks of a coarse picture.
  void search_everywhere(const AreaSums& before) {
    int sum = 0;
    for (int y = 0; y < kBlock_px; ++y) {
      for (int x = 0; x < kBlock_px; ++x) sum += block_.pixels[y * block_.stride + x];
    }
    for (int y = -kFarthest_px; y <= kFarthest_px; y += 2) {
      for (int x = -kFarthest_px; x <= kFarthest_px; x += 2) {
        const Vector2i v = inside({x, y});
        const int least = std::abs(sum - before.at(v.x() - low_.x(), v.y() - low_.y()));
        if (least < cost_) try_at(v);
      }
    }
  }

  void search_far() {
    static const std::array<Vector2i, 8> kAround{
        {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, 1}, {1, -1}, {-1, -1}}};
    for (int step = kFarthest_px; step >= kNearest_px; step /= 2) {
      const Vector2i from = best_;
      for (const Vector2i& v : kAround) try_at(inside(from + step * v));
    }
  }

  /// Moves one pixel at a time and never back in the direction from which it came.
  void walk_downhill() {
    if (lowest_ && *lowest_ == best_) return;
    static const std::array<Vector2i, 4> kSteps{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
    int came_by = -1;
    for (int step = 0; step < kMostSteps; ++step) {
      const Vector2i from = best_;
      int taken = -1;
      for (int k = 0; k < 4; ++k) {
        if (came_by >= 0 && k == (came_by + 2) % 4) continue;
        const Vector2i to = from + kSteps[static_cast<size_t>(k)];
        if (inside(to) == to && try_at(to)) taken = k;
      }
      if (taken < 0) {
        lowest_ = from;
        return;
      }
      came_by = taken;
    }
  }

  int difference() const { return difference_; }
  BlockMatch match() const { return {best_, difference_}; }

 private:
  Vector2i inside(const Vector2i& v) const { return v.cwiseMax(low_).cwiseMin(high_); }

  bool try_at(const Vector2i& v) {
    const int deviation_px = (v - expected_).cwiseAbs().sum();
    const int dearer = kLambda * std::min(deviation_px, kMaxDeviation_px);
    if (dearer >= cost_) return false;
    const BlockPixels there{origin_ + v.y() * before_.stride() + v.x(), before_.stride()};
    const int difference = block_difference(block_, there, cost_ - dearer);
    if (difference + dearer >= cost_) return false;
    cost_ = difference + dearer;
    difference_ = difference;
    best_ = v;
    return true;
  }

  const PaddedImage& before_;
  BlockPixels block_;
  const uint8_t* origin_;
  Vector2i low_;
  Vector2i high_;
  Vector2i expected_{0, 0};
  std::array<Vector2i, 9> candidates_;
  int count_ = 0;
  Vector2i best_{0, 0};
  std::optional<Vector2i> lowest_;  ///< the position from which no step is better
  int cost_ = std::numeric_limits<int>::max();
  int difference_ = 0;
};

}  // namespace

void BlockSearch::find(const PaddedImage& before, const PaddedImage& now, const BlockGrid& grid,
                       const std::vector<BlockMatch>& hints, std::vector<BlockMatch>& matches) {
  last_ = matches;
  if (hints.empty()) before_sums_.resize(before.width(), before.height());
  bool has_sums = false;
  for (size_t i = 0; i < matches.size(); ++i) {
    const size_t above = i - static_cast<size_t>(grid.columns);
    const size_t below = i + static_cast<size_t>(grid.columns);
    const bool has_left = grid.column(i) > 0;
    const bool has_right = grid.column(i) + 1 < grid.columns;
    const bool has_above = grid.row(i) > 0;
    Walk walk(before, now, grid.corner_of(i));

    Vector2i expected = last_[i].from_px;
    if (has_left && has_above && has_right) {
      expected = middle(matches[i - 1].from_px, matches[above].from_px, matches[above + 1].from_px);
    } else if (has_left) {
      expected = matches[i - 1].from_px;
    } else if (has_above) {
      expected = matches[above].from_px;
    }
    walk.expect(expected);
    walk.add_candidate(expected);
    if (has_left) walk.add_candidate(matches[i - 1].from_px);
    if (has_above) walk.add_candidate(matches[above].from_px);
    if (has_above && has_right) walk.add_candidate(matches[above + 1].from_px);
    walk.add_candidate(last_[i].from_px);
    if (has_right) walk.add_candidate(last_[i + 1].from_px);
    if (grid.row(i) + 1 < grid.rows) walk.add_candidate(last_[below].from_px);
    if (has_left) walk.add_candidate(last_[i - 1].from_px);
    walk.add_candidate({0, 0});
    walk.try_candidates();
    const auto difference = static_cast<float>(walk.difference());
    if (difference > kRounding_grey * kBlockArea_px) walk.walk_downhill();
    // The search is widened only if no nearby position fits, because a repetitive pattern looks the
    // same in many positions.
    if (walk.difference() > kDoubtful_grey * kBlockArea_px) {
      if (hints.empty()) {
        if (!has_sums) before_sums_.read(before);
        has_sums = true;
        walk.search_everywhere(before_sums_);
      } else {
        walk.try_hint(hints[i].from_px);
        if (walk.difference() > kClear_grey * kBlockArea_px) walk.search_far();
      }
      walk.walk_downhill();
    }
    matches[i] = walk.match();
  }
}

void AreaSums::resize(int width, int height) {
  width_ = static_cast<size_t>(width + 2 * kBlockReach_px);
  column_.resize(width_);
  sums_.resize(width_ * static_cast<size_t>(height + 2 * kBlockReach_px - kBlock_px + 1));
}

void AreaSums::read(const PaddedImage& picture) {
  const int first = -kBlockReach_px;
  const int last = picture.height() + kBlockReach_px - kBlock_px;
  std::fill(column_.begin(), column_.end(), uint16_t{0});
  const auto row = [&](int y) { return picture.row(y) - kBlockReach_px; };
  for (int y = first; y < first + kBlock_px - 1; ++y) {
    for (size_t x = 0; x < width_; ++x) column_[x] = static_cast<uint16_t>(column_[x] + row(y)[x]);
  }
  for (int y = first; y <= last; ++y) {
    const uint8_t* const below = row(y + kBlock_px - 1);
    for (size_t x = 0; x < width_; ++x) column_[x] = static_cast<uint16_t>(column_[x] + below[x]);
    uint16_t* const sums = sums_.data() + static_cast<size_t>(y - first) * width_;
    std::copy(column_.begin(), column_.end(), sums);
    // Sums two columns, then four, eight and sixteen; no search reads the incomplete last sums.
    for (size_t n = 1; n < kBlock_px; n *= 2) {
      for (size_t x = 0; x + n < width_; ++x) {
        sums[x] = static_cast<uint16_t>(sums[x] + sums[x + n]);
      }
    }
    const uint8_t* const above = row(y);
    for (size_t x = 0; x < width_; ++x) column_[x] = static_cast<uint16_t>(column_[x] - above[x]);
  }
}

using Eigen::Vector2f;
using Eigen::Vector2i;

MotionBlock refined_block(const PaddedImage& before, const PaddedImage& now,
                          const Vector2i& corner_px, const BlockMatch& match,
                          float regularization) {
  const BlockSums sums =
      compare_blocks(pixels_at(now, corner_px), pixels_at(before, corner_px + match.from_px));
  return refined_block(sums, now, corner_px, match, regularization);
}

MotionBlock refined_block(const BlockSums& s, const PaddedImage& now, const Vector2i& corner_px,
                          const BlockMatch& match, float regularization) {
  // The sums have four times the derivatives. An offset common to all pixels is not motion.
  const float of_each = 1 / static_cast<float>(std::max(s.pixels, 1));
  const auto mean = [&](int32_t sum) { return static_cast<float>(sum) * of_each; };
  const Vector2f g(mean(s.x), mean(s.y));
  const float d = mean(s.difference);
  MotionBlock block;
  Eigen::Matrix2f& S = block.structure;
  S << mean(s.xx), mean(s.xy), mean(s.xy), mean(s.yy);
  S = (S - g * g.transpose()) / 16;
  const Vector2f gd = (Vector2f(mean(s.xd), mean(s.yd)) - g * d) / 4;
  const float dd = mean(s.squared) - d * d;

  // now(p) = before(p + from − e): e = −(Σ g gᵀ)⁻¹ Σ g d.
  const Eigen::Matrix2f regularized = S + regularization * Eigen::Matrix2f::Identity();
  const Vector2f e = (-(regularized.inverse() * gd)).cwiseMax(-kMaxOff_px).cwiseMin(kMaxOff_px);
  const float left = dd + 2 * e.dot(gd) + e.dot(S * e);
  block.centre_px =
      corner_px.cast<float>() +
      0.5f * (Vector2i::Constant(kBlock_px) - Vector2i(now.width(), now.height())).cast<float>();
  block.moved_px = e - match.from_px.cast<float>();
  block.residual = std::max(0.0f, left);
  block.difference = match.difference;
  return block;
}

}  // namespace spidar
