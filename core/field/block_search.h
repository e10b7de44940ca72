// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Where each block of a picture was in the picture before, to whole pixels.
#pragma once

#include <cstdint>
#include <vector>

#include "core/field/area_sums.h"
#include "core/tracking/padded_image.h"

namespace spidar {

/// How far blocks may extend beyond the picture: the padding, less the pixels that compare_blocks()
/// and the interpolation read around them.
constexpr int kBlockReach_px = PaddedImage::kPad_px - 2;

/// Blocks side by side, centred on the picture. The strip that is left at each border is narrower
/// than a block.
struct BlockGrid {
  int columns = 0;
  int rows = 0;
  int left_px = 0;  ///< of the first block
  int top_px = 0;

  static BlockGrid over(int width, int height);
  int size() const { return columns * rows; }
  int x_px(int column) const;
  int y_px(int row) const;
};

/// A block at p was at p + (dx, dy) in the picture before.
struct BlockMatch {
  int16_t dx = 0;  ///< px
  int16_t dy = 0;
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
