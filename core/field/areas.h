// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// How areas of several blocks move: in a picture out of focus, or of ice, no single block shows
/// it.
#pragma once

#include <vector>

#include "core/field/block_field.h"
#include "core/picture/padded_image.h"

namespace spidar {

/// Areas of kCoarser × kCoarser blocks, each of which overlaps its neighbours by half, as measured
/// in the coarse picture. A block with corners is left out: it shows by itself how it moves, and
/// may belong to an object in front of the wall whose motion is wanted. An area of which nothing is
/// left has no structure.
class Areas {
 public:
  /// Allocates what find() needs for pictures of this size: it may be needed long after the first.
  void reserve(const BlockField& field);
  /// Measures the areas. Lengths are in pixels of the field's picture, structure in (grey / px)² of
  /// the coarse one. There are no areas while the field stands still. Valid until the next call.
  const std::vector<MotionBlock>& find(const BlockField& field);

 private:
  void leave_out_corners(const BlockField& field);
  BlockMatch best_match(const CoarseField& coarse, const Eigen::Vector2i& corner_px) const;

  std::vector<MotionBlock> areas_;
  PaddedImage counted_;  ///< of the coarse picture: 255; 0 where a block with corners is
};

/// Factor of a limit of texture, in (grey / px)², for an area: the noise of a pixel of the coarse
/// picture is kCoarser times less than that of the field's.
constexpr float kAreaTextureScale = 1.0f / (kCoarser * kCoarser);

}  // namespace spidar
