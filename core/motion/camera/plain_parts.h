// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What the parts of the picture that do not vote say about the motion of the camera.
#pragma once

#include <array>
#include <vector>

#include "core/motion/camera/block_votes.h"

namespace spidar {

/// The blocks without corners. Each is compared with that of the last four pictures from which the
/// camera has moved it furthest: noise that an encoder has moved along with an object in one
/// picture is new some pictures later, whereas shading and stains are still there. The sums of
/// cells are compared, in which noise counts little.
class PlainParts {
 public:
  /// Whether they show that they move like the model.
  bool have_moved(const BlockField& field, const Past& past, const MotionModel& model);

  /// The model of this picture, for the next ones. One that is shown again does not count.
  void remember(const BlockField& field, const MotionModel& model);
  void reset() { models_.fill(MotionModel()); }

 private:
  void go_back(const BlockField& field, const MotionModel& model);

  std::array<MotionModel, kMostBack - 1> models_;  ///< of earlier pictures, the latest first
  std::vector<Eigen::Vector2d> moved_px_;  ///< of each block, since the picture that is compared
  std::vector<Eigen::Vector2d> steps_px_;  ///< the same, since each picture before it
  int back_ = 0;                           ///< how many pictures ago that was; 0: none
};

}  // namespace spidar
