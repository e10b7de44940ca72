// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The grid of blocks of a picture, and the search, in whole pixels, for the place of each block in
/// the previous picture.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "core/field/block_kernels.h"
#include "core/picture/padded_image.h"

namespace spidar {

/// Blocks side by side, centred on the picture and numbered row by row. The strip at each border
/// that no block covers is narrower than a block.
struct BlockGrid {
  int columns = 0;
  int rows = 0;
  Eigen::Vector2i corner_px{0, 0};  ///< upper left pixel of the first block

  static BlockGrid over(int width, int height) {
    const Eigen::Vector2i size_px(width, height);
    const Eigen::Vector2i blocks = size_px / kBlock_px;
    return {blocks.x(), blocks.y(), (size_px - blocks * kBlock_px) / 2};
  }

  size_t size() const { return static_cast<size_t>(columns * rows); }
  size_t index(int column, int row) const { return static_cast<size_t>(row * columns + column); }
  int column(size_t block) const { return static_cast<int>(block) % columns; }
  int row(size_t block) const { return static_cast<int>(block) / columns; }

  Eigen::Vector2i corner_of(size_t block) const {
    return corner_px + kBlock_px * Eigen::Vector2i(column(block), row(block));
  }
  /// The block that contains a position, in px from the corner of the picture, or the nearest one.
  size_t block_at(const Eigen::Vector2d& at_px) const {
    const Eigen::Vector2d blocks = (at_px - corner_px.cast<double>()) / kBlock_px;
    const auto inside = [](double position, int count) {
      return std::clamp(static_cast<int>(std::floor(position)), 0, count - 1);
    };
    return index(inside(blocks.x(), columns), inside(blocks.y(), rows));
  }

  /// How many columns, or rows, lie between a block and the nearer side of the grid.
  int columns_beside(size_t block) const {
    return std::min(column(block), columns - 1 - column(block));
  }
  int rows_beside(size_t block) const { return std::min(row(block), rows - 1 - row(block)); }

  /// Calls `visit(other)` for a block and all others at most `reach` columns and rows away.
  template <typename Visit>
  void each_around(size_t block, int reach, Visit&& visit) const {
    const int left = std::max(column(block) - reach, 0);
    const int right = std::min(column(block) + reach, columns - 1);
    const int last = std::min(row(block) + reach, rows - 1);
    for (int y = std::max(row(block) - reach, 0); y <= last; ++y) {
      for (int x = left; x <= right; ++x) visit(index(x, y));
    }
  }
  /// Whether `is(other)` holds for a block or one of its eight neighbours.
  template <typename Is>
  bool any_around(size_t block, Is&& is) const {
    bool any = false;
    each_around(block, 1, [&](size_t other) { any = any || is(other); });
    return any;
  }
  /// Calls `visit(other)` for the blocks at the left, at the right, above and below.
  template <typename Visit>
  void each_beside(size_t block, Visit&& visit) const {
    if (column(block) > 0) visit(block - 1);
    if (column(block) + 1 < columns) visit(block + 1);
    if (row(block) > 0) visit(block - static_cast<size_t>(columns));
    if (row(block) + 1 < rows) visit(block + static_cast<size_t>(columns));
  }
};

/// Σ of the pixels at each position of a block. Two blocks differ by at least as much as their sums
/// do (successive elimination: Li and Salari, 1995), so most positions of a search are skipped.
class AreaSums {
 public:
  /// For pictures of this size. Keeps the memory when the size is the same.
  void resize(int width, int height);
  /// Sums the positions of a block that lie at most kBlockReach_px beyond the edge.
  void read(const PaddedImage& picture);

  /// The sum at the position that is `right_px` to the right of the first one and `down_px` below
  /// it.
  int at(int right_px, int down_px) const {
    return sums_[static_cast<size_t>(down_px) * width_ + static_cast<size_t>(right_px)];
  }

 private:
  size_t width_ = 0;              ///< px that are read of a row
  std::vector<uint16_t> column_;  ///< Σ of the rows of a position
  std::vector<uint16_t> sums_;    ///< at most 16 · 16 · 255 < 2¹⁶
};

/// How far blocks may extend beyond the picture: the padding, less the pixels that compare_blocks()
/// and the interpolation read around them.
constexpr int kBlockReach_px = PaddedImage::kPad_px - 2;

/// A block at p was at p + from_px in the previous picture.
struct BlockMatch {
  Eigen::Vector2i from_px{0, 0};
  int difference = 0;  ///< Σ |now − before| of the block
};

/// Searches like a video encoder: starts with the motions of the neighbouring blocks and of the
/// previous frame, descends from the best of these, and widens the search only if none fits. A
/// motion that deviates from that of the neighbours must fit better in proportion; textureless
/// blocks therefore move with their neighbours.
class BlockSearch {
 public:
  /// On entry `matches` holds those of the previous picture, one for each block of `grid`; on
  /// return, those of `now`. Both pictures have the same size and repeated borders. `hints`, if
  /// there are any, are additional candidates for each block.
  void find(const PaddedImage& before, const PaddedImage& now, const BlockGrid& grid,
            const std::vector<BlockMatch>& hints, std::vector<BlockMatch>& matches);

 private:
  std::vector<BlockMatch> last_;
  AreaSums before_sums_;  ///< for a search of the whole range
};

template <typename Scalar>
Scalar smaller_eigenvalue(const Eigen::Matrix<Scalar, 2, 2>& S) {
  const Scalar unequal = S(0, 0) - S(1, 1);
  return (S.trace() - std::sqrt(unequal * unequal + 4 * S(0, 1) * S(0, 1))) / 2;
}

/// Smaller over larger eigenvalue of a structure tensor: 0 for a single edge, whose motion along
/// itself is invisible.
template <typename Scalar>
Scalar roundness(const Eigen::Matrix<Scalar, 2, 2>& S) {
  const Scalar smaller = smaller_eigenvalue(S);
  return S.trace() > 0 ? smaller / (S.trace() - smaller) : 0;
}

/// The largest correction of a block's motion by refined_block(), px of the picture in which motion
/// is measured. A motion in whole pixels is right to half a pixel, or wrong: a block that needs a
/// larger correction shows something else.
constexpr float kMaxOff_px = 1;

/// A block of kBlock_px × kBlock_px pixels of the picture in which motion is measured. Lengths are
/// in pixels of that picture, measured from its centre; x right, y down.
struct MotionBlock {
  Eigen::Vector2f centre_px = Eigen::Vector2f::Zero();
  Eigen::Vector2f moved_px = Eigen::Vector2f::Zero();  ///< since the previous picture
  /// Structure tensor: mean of g gᵀ over the block, without its common slope, (grey / px)².
  Eigen::Matrix2f structure = Eigen::Matrix2f::Zero();
  /// The residual of the block's motion: mean squared difference without its common offset, grey².
  float residual = 0;
  int difference = 0;  ///< Σ |now − before| at the nearest whole pixel

  /// Added to the diagonal of the structure tensor, (grey / px)²: with hardly any texture, the
  /// result of the search in whole pixels stays.
  static constexpr float kRegularization = 1;
  /// The smaller eigenvalue from which on the motion is known to a fraction of a pixel, (grey /
  /// px)²: twice that of pure noise of two grey levels, which moves such a block by 0.08 px.
  static constexpr float kMinTexture = 5;
  /// Whether the motion is known in one direction at least.
  bool has_texture() const { return structure.trace() > 2 * kMinTexture; }
  /// The least roundness() of a structure that is not that of an edge. Along an edge, a match would
  /// only follow noise.
  static constexpr double kMinRoundness = 0.05;
  /// The smaller eigenvalue of the structure tensor, which is large when the motion is known in
  /// every direction, also along an edge.
  float weakest_texture() const { return smaller_eigenvalue(structure); }
  /// Whether the motion is known to a fraction of a pixel in every direction.
  bool has_corners() const { return weakest_texture() >= kMinTexture; }
};

inline BlockPixels pixels_at(const PaddedImage& picture, const Eigen::Vector2i& corner_px) {
  return {picture.row(corner_px.y()) + corner_px.x(), picture.stride()};
}

/// Refines the motion of the block whose upper left pixel is `corner_px`, which the search in whole
/// pixels has found at `match`, by one Gauss–Newton step with the derivatives of both pictures.
/// Using both makes the step second-order exact (Benhimane and Malis: Real-time image-based
/// tracking of planes using efficient second-order minimization, IROS 2004). `regularization` is
/// added to the diagonal of the structure tensor, (grey / px)²: with hardly any texture, the result
/// of the search stays.
MotionBlock refined_block(const PaddedImage& before, const PaddedImage& now,
                          const Eigen::Vector2i& corner_px, const BlockMatch& match,
                          float regularization);
/// The same, from the `sums` that compare_blocks() returns for this match.
MotionBlock refined_block(const BlockSums& sums, const PaddedImage& now,
                          const Eigen::Vector2i& corner_px, const BlockMatch& match,
                          float regularization);

}  // namespace spidar
