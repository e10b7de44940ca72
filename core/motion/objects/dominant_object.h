// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstdint>
#include <vector>

#include "core/motion/objects/moving_object.h"

namespace spidar {

/// Chooses the object that the hand follows. Keeps following an object until the reason to follow
/// another one is strong enough, so that the force jumps neither between similar objects nor to one
/// that stands out in a few frames only.
///
/// Each rival has a reason to be followed, in seconds, which grows at the rate (p − c f) / (p + c
/// f). p is the prominence of the rival and f that of the followed object. c grows from 1 to
/// kClearly in the first kSettles_s in which the followed object is visible, because it is mostly
/// chance which of two objects is found first. The rate is 1 when the followed object rests or is
/// invisible, 0 when the rival is c times as prominent, and −1 when the rival rests. A rival whose
/// reason reaches kReason_s replaces the followed object. An eye decides in a similar way where to
/// look next: a signal rises to a threshold (Carpenter and Williams 1995).
///
/// No reason falls below −kReason_s, nor below 0 while the followed object is invisible. An object
/// that has stood out for long may therefore rest for twice kReason_s. The reason of a rival that
/// appears while the followed object is invisible begins at half of the time since that object was
/// lost.
///
/// Some objects are followed at once: the first one; any one after the followed object has left at
/// the border of the picture; any one that appears when the followed object has been lost for twice
/// kReason_s; and, while the followed object is invisible, an object that covers half of the place
/// where the followed one would be, because it is a part of the same object. An object that first
/// appears where the lost one may have gone, in any direction, counts as the lost one: a ball may
/// bounce in a frame in which it is not found.
class DominantObject {
 public:
  DominantObject();

  /// Returns one of `objects`, at first the most prominent one. Null when none has moved yet, and
  /// while the followed object is not among them. Call this once for each frame, `interval_s` > 0
  /// after the previous one.
  const MovingObject* choose(const std::vector<MovingObject>& objects, double interval_s);

  void reset();

  /// How many times as prominent as the followed object a rival must be. On real films, 4 to 8 make
  /// little difference; with 3, there are a tenth more changes.
  static constexpr double kClearly = 4;
  /// How long an object must be followed, and be visible, before c reaches kClearly. On real films,
  /// one second and two make no difference.
  static constexpr double kSettles_s = 2;
  /// The reason at which a rival is followed: an eye takes 0.2 s and more to turn to a new target.
  static constexpr double kReason_s = 0.3;

 private:
  struct Rival {
    uint32_t id = 0;
    double reason_s = 0;
  };

  double reason_before(uint32_t id) const;
  bool may_be_it(const MovingObject& object) const;

  uint32_t id_ = 0;        ///< 0: none
  double lost_s_ = 0;      ///< since the followed object was visible
  double followed_s_ = 0;  ///< how long the followed object has been visible
  /// The box of the followed object when it was last visible, extended by how far it may have moved
  /// since; its speed then; and the id of the newest object then.
  Eigen::AlignedBox2d last_box_px_;
  double last_speed_px_s_ = 0;
  uint32_t newest_id_ = 0;
  std::vector<Rival> rivals_;  ///< all others of the last frame
  std::vector<Rival> next_;
};

}  // namespace spidar
