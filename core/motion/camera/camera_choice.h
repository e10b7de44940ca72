// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Chooses what shows how the camera moves: blocks, areas or edges.
#pragma once

#include <vector>

#include "core/motion/camera/background.h"
#include "core/motion/camera/block_votes.h"
#include "core/motion/camera/plain_parts.h"

namespace spidar {

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
  std::vector<MotionBlock> areas_;
  PlainParts plain_;
  BackgroundEstimator estimator_;
};

}  // namespace spidar
