// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The object that the hand follows.
#pragma once

#include <cstdint>
#include <vector>

#include "core/motion/moving_object.h"

namespace spidar {

/// Stays with an object until there has been reason enough to leave it, so that the force does not
/// jump between similar objects, nor to one that stands out in a few frames only.
///
/// The reason for each other object grows at the rate (p − c f) / (p + c f), for its prominence p,
/// that of the object that is followed f, and c = kClearly: 1 when the latter rests or is out of
/// sight, 0 when the other one is three times as prominent, −1 when the other one rests. At
/// kReason_s it takes over. So an eye decides where to look next: by a signal that rises to a
/// threshold, the faster the more the target stands out (Carpenter and Williams 1995).
///
/// A reason falls to −kReason_s at most, and not below 0 while the object that is followed is out
/// of sight: what has stood out for long may rest for twice kReason_s. An object that appears while
/// that one is out of sight begins with half of the time since it was lost, so that after twice
/// kReason_s it is followed at once. At first the most prominent object is followed at once.
class DominantObject {
 public:
  DominantObject();

  /// Returns one of `objects`, at first the most prominent one. Null when none has moved yet, and
  /// while the one that is followed is not among them. Call this once for each frame,
  /// `interval_s` > 0 after the one before.
  const MovingObject* choose(const std::vector<MovingObject>& objects, double interval_s);

  void reset();

  /// On real films, 2 … 4 give nearly the same results.
  static constexpr double kClearly = 3;
  /// So long an eye takes to begin to turn to a new target. On real films, 0.22 s gives the same
  /// results, 0.18 s more false force; with 0.3 s what replaces a lost object is felt too late.
  static constexpr double kReason_s = 0.2;

 private:
  struct Rival {
    uint32_t id = 0;
    double reason_s = 0;
  };

  double reason_before(uint32_t id) const;

  uint32_t id_ = 0;            ///< 0: none
  double lost_s_ = 0;          ///< since the object that is followed was in sight
  std::vector<Rival> rivals_;  ///< all others of the last frame
  std::vector<Rival> next_;
};

}  // namespace spidar
