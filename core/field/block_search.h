// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Where each block of a picture was in the picture before, to whole pixels.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "core/field/block_grid.h"
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

}  // namespace spidar
