// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "core/field/block_field.h"
#include "core/motion/camera/background.h"
#include "core/motion/layers/burned_in.h"

namespace spidar {

/// The deviations of blocks from the background's model, as a covariance.
///
/// When the camera travels, the parts of the scene that are nearer or further away than the model
/// move against the model, all in one direction: that of the epipolar lines. Across these lines
/// there is only noise. An object must move further than parallax and noise explain.
class Parallax {
 public:
  /// `moved_px` is the motion of the blocks of the scene relative to the background. Fewer than
  /// half of the blocks may move by themselves.
  void measure(const std::vector<Eigen::Vector2f>& moved_px);

  /// In px²; zero before measure(), and after measure() of no blocks.
  const Eigen::Matrix2f& covariance_px2() const { return covariance_px2_; }

  /// The standard deviation in the direction of `motion`, px: the radius of the covariance's
  /// ellipse in that direction. 0 if there is no noise, or no direction.
  double sigma_px(const Eigen::Vector2d& motion) const;

 private:
  Eigen::Matrix2f covariance_px2_ = Eigen::Matrix2f::Zero();
  std::vector<float> sizes_;  ///< squared lengths, then lengths in one direction
};

/// A block compared with the background. Lengths are in pixels of the field's picture.
struct RelativeBlock {
  Eigen::Vector2f moved_px = Eigen::Vector2f::Zero();       ///< relative to the background
  Eigen::Vector2f background_px = Eigen::Vector2f::Zero();  ///< of the background there
  bool shows_motion = false;  ///< its texture, or its pixels, determine its motion
  bool was_outside = false;   ///< most of it was outside the film in the previous picture
  bool is_occluded = false;   ///< graphics hide the film here, see BurnedIn::occludes()
  bool lasts = false;         ///< has stood out for so long that it needs no neighbour to move
  bool moves = false;         ///< moves by itself, with its neighbours considered
};

/// How far the motion of a limb may differ from that of its body, as a fraction of the faster one.
constexpr double kAlikeFraction = 0.5;

/// How much two motions of the same object may differ, px of the field's picture: kAlikeFraction of
/// `fastest_px`, the length of the longer one, plus three standard deviations of a block's motion.
double alike_px(double fastest_px);

/// Whether two motions may be of the same object.
bool are_alike(const Eigen::Vector2f& a_px, const Eigen::Vector2f& b_px);

/// Finds the blocks that move by themselves, by comparison with the background. Three conditions
/// hold for such a block:
/// - Its motion is further from the background's than its own error and the background's noise
///   explain.
/// - The background's motion explains the pixels of the block clearly worse than the block's own
///   motion does, and far worse if the block has no texture, as out of focus. Pixels do not
///   separate motions that differ by less than a pixel: a slow block must stand out from the
///   parallax of the scene instead, unless the camera rests or an object is known there.
/// - It has neighbours that stand out, or it lasts. A single block that stands out is an error.
///
/// While the motion of the background is unknown, no block is known to move by itself.
class MovingBlocks {
 public:
  /// `expected` is 1 for each block on which an object was in the previous frame, or is expected in
  /// this one; such a block needs less evidence.
  const std::vector<RelativeBlock>& find(const BlockField& field, const Background& background,
                                         const std::vector<uint8_t>& expected);

  /// The probability that each block is foreground, from the frames so far, 0 … 1. The values move
  /// along with the picture.
  const std::vector<float>& foreground() const { return foreground_; }

  /// Blocks with burned-in graphics or bars, which do not show the motion of camera or objects.
  const BurnedIn& burned_in() const { return burned_in_; }

  void reset();

 private:
  /// The fraction of the last frames in which a block stood out with nearly the same motion, and
  /// its motion in the last of them.
  struct StoodOut {
    float fraction = 0;
    Eigen::Vector2f moved_px = Eigen::Vector2f::Zero();
  };

  void compare(const BlockField& field, const Background& background,
               const std::vector<uint8_t>& expected);
  void measure_parallax(const BlockField& field);
  bool stands_out(const BlockField& field, size_t index, const Eigen::Matrix2f& noise_px2,
                  bool expected) const;
  void exclude_burned_in(const BlockField& field, const std::vector<uint8_t>& expected);
  void confirm_with_neighbours(const BlockGrid& grid);
  void store_stood_out(const BlockField& field);
  void remember_motion(const BlockField& field);

  std::vector<RelativeBlock> relative_;
  std::vector<uint8_t> stands_out_;  ///< for each block, its neighbours not considered
  std::vector<float> foreground_;
  std::vector<float> foreground_before_;
  std::vector<StoodOut> stood_out_;
  std::vector<StoodOut> stood_out_before_;
  std::vector<Eigen::Vector2f> of_scene_px_;  ///< motion of the blocks of the scene
  Parallax parallax_;
  BurnedIn burned_in_;
  bool camera_is_still_ = true;
};

}  // namespace spidar
