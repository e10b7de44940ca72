// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The direction in which depth moves the parts of a still scene.
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace spidar {

/// A block's motion relative to the background. `at` is its place from the centre of the picture,
/// in units of half the picture's width.
struct ResidualMotion {
  Eigen::Vector2f at;
  Eigen::Vector2f moved_px;
  float weight = 0;  ///< 0 … 1
};

/// What is nearer or further than the plane to which the background's model belongs moves towards
/// one point of the picture, the epipole, or away from it (Irani and Anandan: A unified approach to
/// moving object detection in 2D and 3D scenes, IEEE Trans. PAMI 20, 1998). What moves by itself
/// moves in any direction.
///
/// The epipole f, in homogeneous coordinates, minimises Σ w (f·l)² with l = (e_y, −e_x, e_x p_y −
/// e_y p_x), where e is the motion of a block at p: f·l is the part of e across the direction
/// towards f, times the distance from it. Weights decrease with this part, as those of Cauchy's
/// distribution.
class Epipole {
 public:
  /// `sigma_px`: noise of the background.
  void find(const std::vector<ResidualMotion>& blocks, float sigma_px);

  /// False if too few blocks move against the background.
  bool is_known() const { return is_known_; }
  /// Unit vector at a place along which a still scene may move. Most blocks move in this direction
  /// rather than in the opposite one.
  Eigen::Vector2f direction(const Eigen::Vector2f& at) const;
  /// Of the blocks that move against the background: the share that moves along direction().
  float agreeing() const { return agreeing_; }
  /// Of all blocks: the share that moves against the background.
  float moving() const { return moving_; }

 private:
  void judge(const std::vector<ResidualMotion>& blocks, float least_px);

  Eigen::Vector3f epipole_ = Eigen::Vector3f::Zero();
  bool is_known_ = false;
  float agreeing_ = 0;
  float moving_ = 0;
};

}  // namespace spidar
