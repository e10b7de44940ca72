// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <array>
#include <vector>

#include "core/field/coarse_blocks.h"
#include "core/motion/camera/background.h"
#include "core/motion/camera/block_votes.h"

namespace spidar {

/// Tests a motion of the camera in the blocks without corners. Compares the picture with one of the
/// last four: the one since which the camera has moved these blocks furthest. Noise that an encoder
/// moved along with an object is new some pictures later, whereas shading and stains remain.
/// Compares the sums of cells, in which noise counts little.
class PlainParts {
 public:
  bool have_moved(const BlockField& field, const PreviousFrame& past, const MotionModel& model);

  /// Keeps the model of this picture for the next ones. A repeated picture does not count.
  void remember(const BlockField& field, const MotionModel& model);
  void reset() { models_.fill(MotionModel()); }

 private:
  void find_furthest_picture(const BlockField& field, const MotionModel& model);

  std::array<MotionModel, kMaxBack - 1> models_;  ///< of earlier pictures, the latest first
  std::vector<Eigen::Vector2d> moved_px_;  ///< motion of each block since the compared picture
  std::vector<Eigen::Vector2d> steps_px_;  ///< motion of each block since the examined picture
  int back_ = 0;                           ///< how many pictures ago the compared one was; 0: none
};

/// Chooses the evidence for the camera's motion. Blocks vote first. Where the blocks show rest or
/// nothing, and are not many, coarse blocks vote. Coarse blocks also move with a large object in
/// front of them, so the plain parts or the border must show the same motion. Last of all, edges
/// vote along with the blocks if the blocks are few. The votes give the first choice; a motion that
/// explains clearly more of the border replaces it.
class CameraChoice {
 public:
  CameraChoice();

  const Background& find(const BlockField& field, const PreviousFrame& past);

  /// The number of votes for the last background.
  size_t votes() const { return votes_.cast.size(); }
  /// Learns the noise as BackgroundEstimator does, from these votes.
  template <typename Moves>
  void learn_noise(Moves&& moves) {
    estimator_.learn_noise(votes_, moves);
  }

  /// Call this after a cut or a seek.
  void reset();

 private:
  Background find_in_order(const BlockField& field, const PreviousFrame& past);
  void prefer_rival(const BlockField& field, const PreviousFrame& past, Background& chosen);
  void add_rivals(const BlockField& field, const PreviousFrame& past, const Background& chosen);
  const MotionModel* best_rival(const BlockField& field, const PreviousFrame& past,
                                const Background& chosen, bool was_rival);
  template <typename Counts>
  void add_rival(const Background& chosen, const BackgroundVotes& votes, Counts&& counts);

  BackgroundVotes votes_;  ///< for the last background
  BackgroundVotes coarse_votes_;
  BackgroundVotes rival_votes_;
  CoarseBlocks coarse_blocks_;
  PlainParts plain_;
  /// The model that explains the picture best, chosen or not: over several pictures the plain parts
  /// may show what they do not show in one.
  MotionModel likely_;
  BackgroundEstimator estimator_;
  WeightedDisplacements evidence_;
  std::vector<MotionModel> models_;  ///< the first choice, then its rivals
  std::vector<double> shares_;       ///< of the border that each of them explains
  bool is_rival_ = false;            ///< whether the last background is a rival
};

}  // namespace spidar
