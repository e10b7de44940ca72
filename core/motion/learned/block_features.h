// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What the network is told of each block.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/field/block_field.h"
#include "core/motion/camera/background.h"
#include "core/motion/camera/relative_block.h"
#include "core/motion/learned/epipole.h"

namespace spidar {

/// Numbers of a block, see the list in block_features.cpp.
constexpr int kFeatures = 44;
/// No feature is larger.
constexpr float kMostFeature = 8;

/// kFeatures numbers for each block, most of them between −1 and 1. Does not allocate after the
/// first frames of a size.
class BlockFeatures {
 public:
  /// Call for each pair of pictures. `background` is in pixels of the field's picture;
  /// `parallax_px2` is how much the parts of a still scene move against it.
  void measure(const BlockField& field, const Background& background,
               const std::vector<RelativeBlock>& relative, const Eigen::Matrix2f& parallax_px2);

  /// Of the last measure(), block by block; empty before.
  const std::vector<float>& values() const { return values_; }
  /// BlockField::origin_of() each block.
  const std::vector<uint32_t>& origins() const { return origins_; }

  /// Forgets the pictures before, after a cut or a seek.
  void reset();

 private:
  /// Motion relative to the background.
  struct Content {
    Eigen::Vector2f moved_px = Eigen::Vector2f::Zero();  ///< in the last pair
    Eigen::Vector2f mean_px = Eigen::Vector2f::Zero();   ///< in the last pairs
    float pairs = 0;                                     ///< of pictures, of `mean_px`
  };
  struct Weighted {
    Eigen::Vector2f sum_px = Eigen::Vector2f::Zero();
    float weight = 0;
  };

  void follow(const BlockField& field, const std::vector<RelativeBlock>& relative);
  void look_around(const BlockField& field);
  void find_epipole(const BlockField& field, const Background& background,
                    const std::vector<RelativeBlock>& relative);

  std::vector<float> values_;
  std::vector<uint32_t> origins_;
  std::vector<Content> content_;
  std::vector<Content> content_before_;
  std::vector<Weighted> own_;     ///< motion of each block, weighted by its texture
  std::vector<Weighted> in_row_;  ///< sums over the blocks beside
  std::vector<Weighted> around_;  ///< sums over the blocks around
  std::vector<ResidualMotion> of_scene_;
  Epipole epipole_;
};

}  // namespace spidar
