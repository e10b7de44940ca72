// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Where each block of a picture was in the picture before, to whole pixels.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "core/field/block_grid.h"
#include "core/field/block_kernels.h"
#include "core/picture/padded_image.h"

namespace spidar {

/// Σ of the pixels of each area of the size of a block. Two blocks differ by at least as much as
/// their sums do (successive elimination: Li and Salari, 1995), so that most positions of a search
/// need not be looked at.
class AreaSums {
 public:
  /// For pictures of this size. Keeps the memory when the size is the same.
  void resize(int width, int height);
  /// Sums the areas of a block's size that lie at most kBlockReach_px beyond the edge.
  void read(const PaddedImage& picture);

  /// The sum of the area whose first pixel is `right_px`, `down_px` from the first one of all.
  int at(int right_px, int down_px) const {
    return sums_[static_cast<size_t>(down_px) * width_ + static_cast<size_t>(right_px)];
  }

 private:
  size_t width_ = 0;              ///< px that are read of a row
  std::vector<uint16_t> column_;  ///< Σ of the rows of an area
  std::vector<uint16_t> sums_;    ///< at most 16 · 16 · 255 < 2¹⁶
};

/// How far blocks may extend beyond the picture: the padding, less the pixels that compare_blocks()
/// and the interpolation read around them.
constexpr int kBlockReach_px = PaddedImage::kPad_px - 2;

/// A block at p was at p + from_px in the picture before.
struct BlockMatch {
  Eigen::Vector2i from_px{0, 0};
  int difference = 0;  ///< Σ |now − before| of the block
};

/// Searches as video encoders do: starts with the motions of the neighbouring blocks and of the
/// frame before, descends from the best of these, and widens the search only if none fits. A motion
/// that deviates from that of the neighbours must fit better in proportion; textureless blocks
/// therefore move with their neighbours.
class BlockSearch {
 public:
  /// On entry `matches` holds those of the picture before, one for each block of `grid`; on return,
  /// those of `now`. Both pictures have the same size and repeated borders. `hints`, if there are
  /// any, are additional candidates for each block.
  void find(const PaddedImage& before, const PaddedImage& now, const BlockGrid& grid,
            const std::vector<BlockMatch>& hints, std::vector<BlockMatch>& matches);

 private:
  std::vector<BlockMatch> last_;
  AreaSums before_sums_;  ///< where the whole range is searched
};

/// The smaller eigenvalue of a symmetric matrix.
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

/// How far a block's motion in whole pixels may be off: it is right to half a pixel, or wrong. What
/// is further away shows something else, px of the picture in which motion is measured.
constexpr float kMostOff_px = 1;

/// A block of kBlock_px × kBlock_px pixels of the picture in which motion is measured. Lengths are
/// in pixels of that picture, measured from its centre; x right, y down.
struct MotionBlock {
  Eigen::Vector2f centre_px = Eigen::Vector2f::Zero();
  Eigen::Vector2f moved_px = Eigen::Vector2f::Zero();  ///< since the picture before
  /// Structure tensor: mean of g gᵀ over the block, without its common slope, (grey / px)².
  Eigen::Matrix2f structure = Eigen::Matrix2f::Zero();
  /// What the block's motion leaves unexplained: mean squared difference without its common offset,
  /// grey².
  float residual = 0;
  int difference = 0;  ///< Σ |now − before| at the nearest whole pixel

  /// Added to the diagonal of the structure tensor, (grey / px)²: with hardly any texture, the
  /// result of the search in whole pixels is kept.
  static constexpr float kRegularization = 1;
  /// Smaller eigenvalue from which on the motion is known to a fraction of a pixel, (grey / px)²:
  /// twice that of nothing but noise of two grey levels, which moves such a block by 0.08 px.
  static constexpr float kLeastTexture = 5;
  /// Whether the motion is known in one direction at least.
  bool has_texture() const { return structure.trace() > 2 * kLeastTexture; }
  /// With less roundness() it is that of an edge, and a match along the edge would only follow
  /// noise.
  static constexpr double kLeastRoundness = 0.05;
  /// Smaller eigenvalue of the structure tensor. It is large when the motion is known in every
  /// direction, also along an edge.
  float weakest_texture() const { return smaller_eigenvalue(structure); }
  /// Whether the motion is known to a fraction of a pixel in every direction.
  bool has_corners() const { return weakest_texture() >= kLeastTexture; }
};

inline BlockPixels pixels_at(const PaddedImage& picture, const Eigen::Vector2i& corner_px) {
  return {picture.row(corner_px.y()) + corner_px.x(), picture.stride()};
}

/// The block whose upper left pixel is `corner_px`, found in whole pixels at `match`: one
/// Gauss–Newton step with the derivatives of both pictures refines its motion. Using both makes the
/// step second-order exact (Benhimane and Malis: Real-time image-based tracking of planes using
/// efficient second-order minimization, IROS 2004). `regularization` is added to the diagonal of
/// the structure tensor, (grey / px)²: with hardly any texture, the result of the search is kept.
MotionBlock refined_block(const PaddedImage& before, const PaddedImage& now,
                          const Eigen::Vector2i& corner_px, const BlockMatch& match,
                          float regularization);
/// The same from what compare_blocks() gives there.
MotionBlock refined_block(const BlockSums& sums, const PaddedImage& now,
                          const Eigen::Vector2i& corner_px, const BlockMatch& match,
                          float regularization);

}  // namespace spidar
