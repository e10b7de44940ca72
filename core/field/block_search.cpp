// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/field/block_search.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <limits>
#include <optional>

#include "core/field/block_kernels.h"

namespace spidar {
namespace {

/// By how much a match must improve for each pixel that it deviates from the median of its
/// neighbours: an eighth of a grey level for each pixel of the block, for up to half a block.
constexpr int kLambda = kBlockArea_px / 8;
constexpr int kMostDeviation_px = kBlock_px / 2;
/// Where no candidate fits, the search is widened: as far as a block is wide, in halves down to a
/// quarter of it.
constexpr int kFarthest_px = kBlock_px;
constexpr int kNearest_px = kBlock_px / 4;
/// A walk goes as far as a deviation costs more and more.
constexpr int kMostSteps = kMostDeviation_px;

struct Vector {
  int dx;
  int dy;
  bool operator==(const Vector& o) const { return dx == o.dx && dy == o.dy; }
};

int middle(int a, int b, int c) {
  return std::max(std::min(a, b), std::min(std::max(a, b), c));
}

/// The search of one block.
class Walk {
 public:
  Walk(const PaddedImage& before, BlockPixels block, int x_px, int y_px)
      : before_(before),
        block_(block),
        origin_(before.row(y_px) + x_px),
        low_{-x_px - kBlockReach_px, -y_px - kBlockReach_px},
        high_{before.width() + kBlockReach_px - kBlock_px - x_px,
              before.height() + kBlockReach_px - kBlock_px - y_px} {}

  void expect(Vector expected) { expected_ = expected; }

  /// Adds a vector unless it is a candidate already.
  void add_candidate(Vector v) {
    v = inside(v);
    const auto end = candidates_.begin() + count_;
    if (std::find(candidates_.begin(), end, v) == end)
      candidates_[static_cast<size_t>(count_++)] = v;
  }

  void try_candidates() {
    for (int i = 0; i < count_; ++i) try_at(candidates_[static_cast<size_t>(i)]);
  }

  void try_hint(Vector hint) { try_at(inside(hint)); }

  /// Tries every second pixel around rest; used for the few blocks of a coarse picture.
  void search_everywhere(const AreaSums& before) {
    int sum = 0;
    for (int y = 0; y < kBlock_px; ++y) {
      for (int x = 0; x < kBlock_px; ++x) sum += block_.pixels[y * block_.stride + x];
    }
    for (int dy = -kFarthest_px; dy <= kFarthest_px; dy += 2) {
      for (int dx = -kFarthest_px; dx <= kFarthest_px; dx += 2) {
        const Vector v = inside({dx, dy});
        const int least = std::abs(sum - before.at(v.dx - low_.dx, v.dy - low_.dy));
        if (least < cost_) try_at(v);
      }
    }
  }

  void search_far() {
    static constexpr std::array<Vector, 8> kAround{
        {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, 1}, {1, -1}, {-1, -1}}};
    for (int step = kFarthest_px; step >= kNearest_px; step /= 2) {
      const Vector from = best_;
      for (const Vector& v : kAround) {
        try_at(inside({from.dx + step * v.dx, from.dy + step * v.dy}));
      }
    }
  }

  /// Moves one pixel at a time and never back in the direction from which it came.
  void walk_downhill() {
    if (lowest_ && *lowest_ == best_) return;
    static constexpr std::array<Vector, 4> kSteps{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
    int came_by = -1;
    for (int step = 0; step < kMostSteps; ++step) {
      const Vector from = best_;
      int taken = -1;
      for (int k = 0; k < 4; ++k) {
        if (came_by >= 0 && k == (came_by + 2) % 4) continue;
        const Vector& v = kSteps[static_cast<size_t>(k)];
        const Vector to{from.dx + v.dx, from.dy + v.dy};
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
  BlockMatch match() const {
    return {static_cast<int16_t>(best_.dx), static_cast<int16_t>(best_.dy), difference_};
  }

 private:
  Vector inside(Vector v) const {
    return {std::min(std::max(v.dx, low_.dx), high_.dx),
            std::min(std::max(v.dy, low_.dy), high_.dy)};
  }

  bool try_at(Vector v) {
    const int deviation_px = std::abs(v.dx - expected_.dx) + std::abs(v.dy - expected_.dy);
    const int dearer = kLambda * std::min(deviation_px, kMostDeviation_px);
    if (dearer >= cost_) return false;
    const BlockPixels there{origin_ + v.dy * before_.stride() + v.dx, before_.stride()};
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
  Vector low_;
  Vector high_;
  Vector expected_{0, 0};
  std::array<Vector, 9> candidates_{};
  int count_ = 0;
  Vector best_{0, 0};
  std::optional<Vector> lowest_;  ///< around which no step is better
  int cost_ = std::numeric_limits<int>::max();
  int difference_ = 0;
};

Vector vector_of(const BlockMatch& match) {
  return {match.dx, match.dy};
}

}  // namespace

BlockGrid BlockGrid::over(int width, int height) {
  BlockGrid grid;
  grid.columns = width / kBlock_px;
  grid.rows = height / kBlock_px;
  grid.left_px = (width - grid.columns * kBlock_px) / 2;
  grid.top_px = (height - grid.rows * kBlock_px) / 2;
  return grid;
}

int BlockGrid::x_px(int column) const {
  return left_px + column * kBlock_px;
}

int BlockGrid::y_px(int row) const {
  return top_px + row * kBlock_px;
}

void BlockSearch::find(const PaddedImage& before, const PaddedImage& now, const BlockGrid& grid,
                       const std::vector<BlockMatch>& hints, std::vector<BlockMatch>& matches) {
  last_ = matches;
  if (hints.empty()) before_sums_.resize(before.width(), before.height());
  bool has_sums = false;
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const auto i = static_cast<size_t>(row * grid.columns + column);
      const auto above = i - static_cast<size_t>(grid.columns);
      const auto below = i + static_cast<size_t>(grid.columns);
      const bool has_left = column > 0;
      const bool has_right = column + 1 < grid.columns;
      const bool has_above = row > 0;
      const int x_px = grid.x_px(column);
      const int y_px = grid.y_px(row);
      Walk walk(before, {now.row(y_px) + x_px, now.stride()}, x_px, y_px);

      Vector expected = vector_of(last_[i]);
      if (has_left && has_above && has_right) {
        const BlockMatch& a = matches[i - 1];
        const BlockMatch& b = matches[above];
        const BlockMatch& c = matches[above + 1];
        expected = {middle(a.dx, b.dx, c.dx), middle(a.dy, b.dy, c.dy)};
      } else if (has_left) {
        expected = vector_of(matches[i - 1]);
      } else if (has_above) {
        expected = vector_of(matches[above]);
      }
      walk.expect(expected);
      walk.add_candidate(expected);
      if (has_left) walk.add_candidate(vector_of(matches[i - 1]));
      if (has_above) walk.add_candidate(vector_of(matches[above]));
      if (has_above && has_right) walk.add_candidate(vector_of(matches[above + 1]));
      walk.add_candidate(vector_of(last_[i]));
      if (has_right) walk.add_candidate(vector_of(last_[i + 1]));
      if (row + 1 < grid.rows) walk.add_candidate(vector_of(last_[below]));
      if (has_left) walk.add_candidate(vector_of(last_[i - 1]));
      walk.add_candidate({0, 0});
      walk.try_candidates();
      const auto difference = static_cast<float>(walk.difference());
      if (difference > kRounding_grey * kBlockArea_px) walk.walk_downhill();
      // The search is widened only if no nearby position fits, because a repetitive pattern looks
      // the same in many positions.
      if (walk.difference() > kDoubtful_grey * kBlockArea_px) {
        if (hints.empty()) {
          if (!has_sums) before_sums_.read(before);
          has_sums = true;
          walk.search_everywhere(before_sums_);
        } else {
          walk.try_hint(vector_of(hints[i]));
          if (walk.difference() > kClear_grey * kBlockArea_px) walk.search_far();
        }
        walk.walk_downhill();
      }
      matches[i] = walk.match();
    }
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
    // Sums two columns, then four, eight and sixteen; nothing asks for those that do not fit in.
    for (size_t n = 1; n < kBlock_px; n *= 2) {
      for (size_t x = 0; x + n < width_; ++x)
        sums[x] = static_cast<uint16_t>(sums[x] + sums[x + n]);
    }
    const uint8_t* const above = row(y);
    for (size_t x = 0; x < width_; ++x) column_[x] = static_cast<uint16_t>(column_[x] - above[x]);
  }
}

}  // namespace spidar
