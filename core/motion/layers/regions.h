// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Finds connected blocks that move by themselves, and distinguishes objects from layers of the
/// scene by their motion over several frames.
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
  /// Number of blocks at a border: of the picture, of the part of it that was in the previous
  /// picture, or of burned-in graphics that cover the film.
  int border_blocks = 0;
  /// Number of blocks that burned-in graphics cover, or that have such a neighbour.
  int graphics_blocks = 0;
  bool lasts = false;  ///< whether one of its blocks lasts, see RelativeBlock
  Eigen::Vector2d position_px = Eigen::Vector2d::Zero();  ///< of its middle
  Eigen::Vector2d low_px = Eigen::Vector2d::Zero();       ///< upper left corner of its box
  Eigen::Vector2d high_px = Eigen::Vector2d::Zero();      ///< lower right
  /// Median motion relative to the background.
  Eigen::Vector2d relative_px = Eigen::Vector2d::Zero();
  Eigen::Vector2d background_px = Eigen::Vector2d::Zero();  ///< mean motion of the background there
  double roundness = 0;  ///< of the structure tensor of the whole region
};

constexpr int16_t kNoRegion = -1;

/// Finds the regions of a field. Each block is connected with its eight neighbours.
class RegionFinder {
 public:
  RegionFinder() { regions_.reserve(kMaxRegions); }

  /// Finds the regions of the blocks that move, down to single blocks.
  const std::vector<Region>& find(const BlockField& field,
                                  const std::vector<RelativeBlock>& relative);

  const std::vector<int16_t>& labels() const { return labels_; }

  static constexpr size_t kMaxRegions = 128;  ///< for which memory is reserved

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

/// The motion of one region over its last frames.
///
/// When the camera travels, a part of the scene that is nearer than the background also moves
/// against the background. Such a part moves in the same direction as the background and further,
/// so its motion on the screen is larger than its motion relative to the background. An object that
/// the camera follows moves less on the screen than relative to the background.
class LayerEvidence {
 public:
  /// Adds a frame, in px of the field's picture. `relative_px` is the motion of the region relative
  /// to the background, `background_px` that of the background at the region. `noise_px` is the
  /// standard deviation of the motion of the blocks around the region, in the direction of
  /// `relative_px`; it is 0 while the camera rests.
  void add(const Eigen::Vector2d& relative_px, const Eigen::Vector2d& background_px,
           double noise_px, double interval_s);

  /// The motion divided by the noise around the region, both as root mean squares. In a scene with
  /// depth, parts that are further away than the background move against it like an object that the
  /// camera follows, and now and then stand out from the noise. Infinite without noise.
  double contrast() const;

  /// The speed on the screen divided by the speed relative to the background: above 1 for a layer,
  /// below 1 for an object that the camera follows, 1 while the camera rests or shakes in place.
  /// The speed on the screen is that of the mean motion, in which the swings of a hand-held camera
  /// cancel. The other speed is a root mean square, which does not vanish while an object turns
  /// back. Infinite without any motion.
  double ratio() const;

  /// Time constant of the means: longer than a swing of a hand-held camera, at 2 … 10 Hz.
  static constexpr double kMean_s = 0.6;

 private:
  Eigen::Vector2d on_screen_px_ = Eigen::Vector2d::Zero();  ///< mean of the last frames
  double moved_px2_ = 0;                                    ///< mean square, against the background
  double noise_px2_ = 0;                                    ///< mean square
  bool is_empty_ = true;
};

/// How much a region stands out: √area × speed, px² of the field's picture. The result is 0 for the
/// edge of graphics and for a single edge. While the camera moves, the result is also 0 for what
/// looks like a layer, that is, like an effect of the camera's translation in a scene with depth: a
/// layer extends beyond the border of the picture, moves along with the background, or hardly
/// differs from the blocks around it. A region that `was_followed` as an object before may look a
/// little more like a layer, and stand out a little less from the noise.
double salience(const Region& region, const LayerEvidence& evidence, bool camera_moves,
                bool was_followed);

}  // namespace spidar
