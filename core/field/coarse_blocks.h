// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <vector>

#include "core/field/block_field.h"
#include "core/picture/padded_image.h"

namespace spidar {

/// Coarse blocks of kCoarser × kCoarser blocks, which overlap their neighbours by half, measured in
/// the coarse picture: in a picture out of focus, or of ice, no single block shows the motion.
/// Blocks with corners are left out: their own motion is visible, and they may belong to an object
/// in front of the scene whose motion is wanted. An empty coarse block has no structure.
class CoarseBlocks {
 public:
  /// Allocates what find() needs for pictures of this size: its first call may be much later.
  void reserve(const BlockField& field);
  /// Measures the coarse blocks; returns none while the field stands still. Lengths are in pixels
  /// of the field's picture, structure in (grey / px)² of the coarse one.
  const std::vector<MotionBlock>& find(const BlockField& field);

 private:
  void exclude_blocks_with_corners(const BlockField& field);
  BlockMatch best_match(const CoarseField& coarse, const Eigen::Vector2i& corner_px) const;

  std::vector<MotionBlock> blocks_;
  PaddedImage counted_;  ///< mask of the coarse picture: 0 in a block with corners, else 255
};

/// Scales a limit of texture, in (grey / px)², for a coarse block: a pixel of the coarse picture
/// has kCoarser times less noise than one of the field's picture.
constexpr float kCoarseTextureScale = 1.0f / (kCoarser * kCoarser);

}  // namespace spidar
