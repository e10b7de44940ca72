// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Chooses what shows how the camera moves: blocks, areas or edges.
#pragma once

#include <array>
#include <vector>

#include "core/field/areas.h"
#include "core/motion/camera/background.h"
#include "core/motion/camera/block_votes.h"

namespace spidar {

/// Whether the blocks along the border, with texture or without, fit the picture before better if
/// they have moved like the model than if they rest. Known objects are left out; where they have
/// most of the border, it says nothing.
bool border_has_moved(const BlockField& field, const Past& past, const MotionModel& model);

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

/// Blocks vote first. Where they show rest or nothing, and are not many, areas vote. Those move
/// with a large object before them, too: the plain parts or the border must show the same. Last of
/// all, edges vote beside few blocks.
class CameraChoice {
 public:
  CameraChoice();

  const Background& find(const BlockField& field, const Past& past);

  /// How many votes the last background has been found from.
  size_t votes() const { return votes_.cast.size(); }
  /// As BackgroundEstimator does, from these votes.
  template <typename Moves>
  void learn_noise(Moves&& moves) {
    estimator_.learn_noise(votes_, moves);
  }

  /// Forgets everything, after a cut or a seek.
  void reset();

 private:
  const Background& keep(const BlockField& field, const Background& chosen,
                         const MotionModel& likely);

  BackgroundVotes votes_;
  BackgroundVotes area_votes_;
  Areas areas_;
  PlainParts plain_;
  BackgroundEstimator estimator_;
};

}  // namespace spidar
