// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A small network that tells which blocks move by themselves.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/field/block_search.h"

namespace spidar {

/// What the network says of a block: probabilities, 0 … 1.
struct BlockAnswer {
  float moves = 0;     ///< by itself
  float votes = 0;     ///< it is rigid background and may vote on the motion of the camera
  float graphics = 0;  ///< it belongs to the screen
};

/// When a block moves by itself, and what else the network decides.
struct NetworkThresholds {
  float least = 0.5f;            ///< probability
  float least_expected = 0.35f;  ///< the same where an object is expected
  bool votes = false;            ///< how much the blocks of the next frame vote for the camera
};

/// Convolutions over the field of blocks, with a memory of each block that moves along with the
/// picture. core/motion/world/ trains it with rendered films. Does not allocate after the first
/// frames of a size.
class BlockNetwork {
 public:
  /// Takes kFeatures numbers for each block of `grid`, and its BlockField::origin_of().
  const std::vector<BlockAnswer>& answer(const BlockGrid& grid,
                                         const std::vector<uint32_t>& origins,
                                         const std::vector<float>& features);

  /// Of the last answer().
  const std::vector<BlockAnswer>& answers() const { return answers_; }
  /// kMemory numbers for each block, from which the last layer answers: what it shows, and what is
  /// remembered of it.
  const std::vector<float>& memory() const { return both_; }
  static const int kMemory;

  /// Forgets the pictures before, after a cut or a seek.
  void reset() { state_.clear(); }

 private:
  std::vector<float> shown_;
  std::vector<float> around_;
  std::vector<float> state_;
  std::vector<float> both_;
  std::vector<float> gates_;
  std::vector<BlockAnswer> answers_;
};

}  // namespace spidar
