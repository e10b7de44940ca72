// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// How much the parts of a still scene move against the model of its background.
#pragma once

#include <vector>

#include <Eigen/Core>

namespace spidar {

/// The deviations of blocks from the background's model, as a covariance.
///
/// Where the camera travels, what is nearer or further than the model moves against it, and all of
/// it along one direction: that of the epipolar lines. Across them there is only noise. What moves
/// by itself has to stand out from both.
class Parallax {
 public:
  /// Takes the motion of the blocks of the scene relative to the background, px. Those that move by
  /// themselves may be among them as long as they are fewer than half. The order of `moved_px`
  /// stays.
  void measure(const std::vector<Eigen::Vector2f>& moved_px);

  /// px²; zero before measure(), and of no blocks.
  const Eigen::Matrix2f& covariance_px2() const { return covariance_px2_; }

  /// The standard deviation of what moves in the direction of `motion`, px: that of the ellipse in
  /// this direction. 0 if there is no noise, or no direction.
  double sigma_px(const Eigen::Vector2d& motion) const;

 private:
  Eigen::Matrix2f covariance_px2_ = Eigen::Matrix2f::Zero();
  std::vector<float> sizes_;  ///< squared lengths, then lengths in one direction
};

}  // namespace spidar
