// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The object that the hand follows.
#pragma once

#include <cstdint>
#include <vector>

#include "core/motion/moving_object.h"

namespace spidar {

/// Stays with an object until another one has been clearly more prominent (kClearly times) for long
/// enough, so that the force does not jump between similar objects, nor to one that stands out in a
/// few frames only.
///
/// Objects compete by the mean of their prominence over kMean_s. An object that rests, or that
/// cannot be seen, has no prominence: its mean falls, and another one of the same prominence takes
/// its place after kMean_s · ln 2 … ln 3, depending on how long the other one has been there. A
/// single object is followed at once.
class DominantObject {
 public:
  DominantObject();

  /// Returns one of `objects`, at first the most prominent one. Null when none of them moves and
  /// none is followed, and while the one that is followed is not among them but has not been given
  /// up yet. Call this once for each frame, `interval_s` > 0 after the one before.
  const MovingObject* choose(const std::vector<MovingObject>& objects, double interval_s);

  void reset();

  static constexpr double kClearly = 2;
  /// On real films, 0.15 … 0.25 s give the same results. With 0.3 s the right object is found too
  /// late, with 0.1 s there are more changes.
  static constexpr double kMean_s = 0.2;

 private:
  struct Rival {
    uint32_t id = 0;
    double prominence = 0;              ///< mean
    const MovingObject* now = nullptr;  ///< null: not in the list of this frame
  };

  void gather(const std::vector<MovingObject>& objects, double interval_s);

  uint32_t id_ = 0;  ///< 0: none
  std::vector<Rival> rivals_;
};

}  // namespace spidar
