// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Finds connected blocks that move by themselves.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "core/field/block_field.h"
#include "core/motion/layers/moving_blocks.h"

namespace spidar {

/// A connected part of the picture that moves by itself. Lengths are in pixels of the field's
/// picture, positions relative to its centre.
struct Region {
  int blocks = 0;
  /// Number of them at the border of the picture, of the part of it that was in the previous
  /// picture, or of something burned in that covers the film.
  int border_blocks = 0;
  /// Number of them that something burned in covers, or that have such a neighbour.
  int graphics_blocks = 0;
  bool lasts = false;  ///< one of its blocks does, see RelativeBlock
  Eigen::Vector2d position_px = Eigen::Vector2d::Zero();  ///< of its middle
  Eigen::Vector2d low_px = Eigen::Vector2d::Zero();       ///< upper left corner of its box
  Eigen::Vector2d high_px = Eigen::Vector2d::Zero();      ///< lower right
  /// Median motion relative to the background.
  Eigen::Vector2d relative_px = Eigen::Vector2d::Zero();
  Eigen::Vector2d background_px = Eigen::Vector2d::Zero();  ///< mean motion of the background there
  double roundness = 0;  ///< of the structure tensor of the whole region
};

/// Label of blocks that belong to no region.
constexpr int16_t kNoRegion = -1;

/// Finds the regions of a field. Each block is connected with its eight neighbours.
class RegionFinder {
 public:
  RegionFinder() { regions_.reserve(kMostRegions); }

  /// Finds the regions of the blocks that move, down to single blocks.
  const std::vector<Region>& find(const BlockField& field,
                                  const std::vector<RelativeBlock>& relative);

  /// The region of each block, or kNoRegion.
  const std::vector<int16_t>& labels() const { return labels_; }

  static constexpr size_t kMostRegions = 128;  ///< for which memory is reserved

 private:
  int root_of(int block);
  void join(int a, int b);
  void describe(const BlockField& field, const std::vector<RelativeBlock>& relative, Region& region,
                int16_t label);

  std::vector<int> parent_;
  std::vector<int16_t> region_of_root_;
  std::vector<int16_t> labels_;
  std::vector<Eigen::Vector2f> moved_px_;  ///< of the blocks of a region
  std::vector<Region> regions_;
};

}  // namespace spidar
