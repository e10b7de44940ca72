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
/// may be an object's, before a wall whose motion is asked for. An area of which nothing is left
/// has no structure.
class Areas {
 public:
  /// Allocates what find() needs for pictures of this size: it may be needed long after the first.
  void reserve(const BlockField& field);
  /// Their lengths are in pixels of the field's picture, their structure is in (grey / px)² of the
  /// coarse one. There are none while the field stands still. Valid until the next call.
  const std::vector<MotionBlock>& find(const BlockField& field);

 private:
  void leave_out_corners(const BlockField& field);
  BlockMatch best_match(const CoarseField& coarse, const Eigen::Vector2i& corner_px) const;

  std::vector<MotionBlock> areas_;
  PaddedImage counted_;  ///< of the coarse picture: 255; 0 where a block with corners is
};

/// The noise of a pixel of the coarse picture is kCoarser times less than that of the field's, so
/// that a limit of texture, in (grey / px)², is kCoarser² times lower for an area.
constexpr float kAreaTextureScale = 1.0f / (kCoarser * kCoarser);

}  // namespace spidar
