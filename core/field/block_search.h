// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Where each block of a picture was in the picture before, to whole pixels.
#pragma once

#include <cstdint>
#include <vector>

#include "core/tracking/gray_pyramid.h"

namespace spidar {

/// Blocks side by side over a picture, in its middle; what is left at the rim is less than a block.
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

/// A block at p is found at p + (dx, dy) of the picture before.
struct BlockMatch {
  int16_t dx = 0;  ///< px
  int16_t dy = 0;
  int difference = 0;  ///< Σ |now − before| of the block
};

/// Searches as video encoders do: a block begins with what its neighbours and the frame before did,
/// walks downhill from the best of these, and looks further afield only when nothing fits. A motion
/// unlike that of its neighbours has to fit better by what it deviates: textureless blocks follow.
class BlockSearch {
 public:
  /// `matches` are those of the picture before on entry, one a block of `grid`, and those of `now`
  /// on return. The pictures are of one size and have their borders repeated. `hints`, when there
  /// are any, are what else each block may have done.
  void find(const PaddedImage& before, const PaddedImage& now, const BlockGrid& grid,
            const std::vector<BlockMatch>& hints, std::vector<BlockMatch>& matches);

 private:
  std::vector<BlockMatch> last_;
};

}  // namespace spidar
