// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstdint>
#include <vector>

#include "core/field/block_field.h"
#include "core/motion/camera/background.h"

namespace spidar {

/// The results of the previous frame that weight the votes of this frame. Each vector has one value
/// per block, or is empty after a cut.
struct PreviousFrame {
  /// The probability that the block was foreground, 0 … 1.
  const std::vector<float>& foreground;
  const std::vector<uint8_t>& burned_in;  ///< 1: the block showed graphics
  const std::vector<uint32_t>& objects;   ///< the number of the block's object; 0: none
  /// The blocks on each side that black bars or a frame around the film cover.
  int margin_columns = 0;
  int margin_rows = 0;

  float foreground_of(size_t block) const { return foreground.empty() ? 0 : foreground[block]; }
  uint32_t object_of(size_t block) const { return objects.empty() ? 0 : objects[block]; }
  bool is_burned_in(size_t block) const { return !burned_in.empty() && burned_in[block] != 0; }
};

/// Collects into `votes` the votes of the textured blocks of `field`.
void collect_votes(const BlockField& field, const PreviousFrame& past, BackgroundVotes& votes);
/// Like collect_votes(), but edges vote too if they have more than one direction together. For
/// pictures with few textured blocks.
void collect_edges(const BlockField& field, const PreviousFrame& past, BackgroundVotes& votes);
void collect_coarse_blocks(const BlockField& field, const std::vector<MotionBlock>& coarse,
                           const PreviousFrame& past, BackgroundVotes& votes);

}  // namespace spidar
