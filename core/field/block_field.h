// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// How each part of the picture moves, from one frame to the next.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "core/field/block_grid.h"
#include "core/field/block_kernels.h"
#include "core/field/block_search.h"
#include "core/field/field_picture.h"

namespace spidar {

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

/// Motion of blocks between two pictures of about 427 × 240 px: BlockSearch finds it in whole
/// pixels, then one Gauss–Newton step with the derivatives of both pictures refines it. Using both
/// makes the step second-order exact (Benhimane and Malis: Real-time image-based tracking of planes
/// using efficient second-order minimization, IROS 2004).
class BlockField {
 public:
  enum class Result {
    kFirst,  ///< nothing to compare it with: the first picture, or one of another size
    kCut,    ///< a different picture; as with kFirst, all blocks stand still
    kMoved,
  };

  /// `base` is the frame reduced by a power of 2.
  Result update(const PaddedImage& base);

  /// The picture is shown again: all blocks stand still.
  void stand_still();

  /// Forgets the picture before.
  void restart() { has_picture_ = false; }
  bool has_picture() const { return has_picture_; }

  const PaddedImage& picture() const { return now_; }
  const BlockGrid& grid() const { return grid_; }
  /// Blocks of the last update(), row by row.
  const std::vector<MotionBlock>& blocks() const { return blocks_; }
  /// Noise of the two pictures: the residual that a third of the blocks stay below, grey². These
  /// are the ones whose motion explains them best.
  float noise_grey2() const { return noise_grey2_; }
  /// Pixels of the base to one pixel of the picture.
  double scale() const { return pixels_to_one(scale_); }

  enum class Match : uint8_t {
    kPlain,  ///< its pixels differ from their mean by less than a doubtful match
    kFound,
    kLost,  ///< its best match shows something else
  };
  Match match_of(size_t block) const;
  /// Whether more of the blocks for which `counts(block)` holds are lost than found.
  template <typename Counts>
  bool are_lost(Counts&& counts) const {
    int lost = 0;
    int found = 0;
    for (size_t i = 0; i < blocks_.size(); ++i) {
      if (!counts(i)) continue;
      const Match match = match_of(i);
      lost += match == Match::kLost;
      found += match == Match::kFound;
    }
    return lost > found;
  }

  /// Block of the previous picture from which block `index` has come: the nearest one of the grid.
  size_t origin_of(size_t index) const;

  /// Σ |now − before| of a block if it had moved by `moved_px`: the smaller of the values at the
  /// exact position and at the nearest whole pixels. Negative when that position is out of reach.
  int difference_if_moved(size_t block, const Eigen::Vector2f& moved_px) const;

  /// Pixels of a block, or of the area `beside_px` beside it, that stayed in place while their
  /// surroundings moved by `moved_px`; none when that is out of reach.
  StayingPixels staying_pixels(size_t block, const Eigen::Vector2f& moved_px,
                               const Eigen::Vector2i& beside_px = {0, 0}) const;

 private:
  void resize(const PaddedImage& base);
  void reduce(const PaddedImage& base);
  void begin();
  void find_hints();
  bool is_cut();
  int contrast_of(size_t block) const;
  bool is_in_reach(const Eigen::Vector2i& corner_px) const;
  void refine(size_t index);
  void measure_noise();

  FieldScale scale_ = FieldScale::kSame;
  int base_width_ = 0;
  int base_height_ = 0;
  bool has_picture_ = false;
  PaddedImage before_;
  PaddedImage now_;
  BlockGrid grid_;
  BlockSearch search_;
  PaddedImage coarse_before_;  ///< a quarter of the picture's sides
  PaddedImage coarse_now_;
  BlockGrid coarse_grid_;
  std::vector<BlockMatch> coarse_matches_;
  std::vector<BlockMatch> hints_;
  std::vector<BlockMatch> matches_;
  std::vector<MotionBlock> blocks_;
  /// Of a block with texture: squares of Σ |now − before| and of Σ |pixel − mean|.
  struct Textured {
    double difference2;
    double contrast2;
  };
  std::vector<Textured> textured_;
  std::vector<float> residuals_;
  float noise_grey2_ = 0;
};

}  // namespace spidar
