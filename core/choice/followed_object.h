// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// One object that a person chose by its place.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "core/motion/camera/background.h"
#include "core/motion/objects/moving_object.h"

namespace spidar {

/// Finds the object that is at a place, and follows its id. What rests is no object for
/// ObjectTracker after a while; so where none is, and where the object came to rest, the first one
/// that begins to move there is meant. ObjectTracker also begins anew at what looks like a cut; one
/// that then soon moves in the same way where the object would be is the same.
class FollowedObject {
 public:
  enum class State {
    kLooking,   ///< for what is at the place
    kWaiting,   ///< nothing was there: for what will begin to move there
    kFollowed,  ///< or not seen for a moment
    kResting,   ///< where it was last
    kLost,      ///< nobody knows where it is
  };

  /// What is there `since_s` before the frame that see() takes next. Places are in px from the
  /// middle of the frame.
  void begin(const Eigen::Vector2d& place_px, double since_s);

  /// Takes the next frame. The object, as it is in `objects`; null when it is not among them.
  /// `interval_s`, the time since the frame before, and `background` are those of the motion.
  const MovingObject* see(const std::vector<MovingObject>& objects, int frame_height,
                          double interval_s, const Background* background);

  /// All objects have other ids.
  void cut() {
    if (id_ != 0 && (rested_ || hidden_)) state_ = State::kLost;
  }

  State state() const { return state_; }

  /// An object is known from the second frame on in which it moves; so long is looked for one.
  static constexpr double kLook_s = 0.5;
  /// An object that is not seen for longer is lost. ObjectTracker knows a hidden one for 0.5 s.
  static constexpr double kLost_s = 1;
  /// How far from its box a place may be, as a share of the frame's height.
  static constexpr double kReach = 0.05;

 private:
  const MovingObject* at_place(const std::vector<MovingObject>& objects, double reach_px) const;
  bool may_be(const MovingObject& object) const;
  void follow(const MovingObject& object);
  void miss(double interval_s);

  State state_ = State::kLost;
  bool is_first_ = true;  ///< see()
  uint32_t id_ = 0;
  Eigen::Vector2d place_px_ = Eigen::Vector2d::Zero();       ///< where it is, or would be
  Eigen::Vector2d velocity_px_s_ = Eigen::Vector2d::Zero();  ///< relative to the background
  double since_s_ = 0;                                       ///< begin()
  double missing_s_ = 0;
  bool rested_ = false;                ///< when it was seen last
  bool hidden_ = false;                ///< the same
  std::array<uint32_t, 32> before_{};  ///< ids in the frame before
  size_t before_count_ = 0;
};

}  // namespace spidar
