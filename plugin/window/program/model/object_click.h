// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Clicks on the objects of the picture in a debug window.
#pragma once

#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include "plugin/window/view/mouse_hand.h"
#include "plugin/window/view/window_view.h"

namespace spidar {

/// The object in sight whose box has the place in it, the smallest of several; null when none has.
/// Places are shares of the visible part of the frame.
const MovingObject* object_at(const FrameReport& report, const Eigen::Vector2d& place);

/// A place that is in the box of this object and in no smaller one, if there is such a place: a
/// click there means it. As a share of the visible part of the frame.
Eigen::Vector2d place_of(const FrameReport& report, const MovingObject& object);

/// Whether objects are known, and not merely touched.
bool offers_choice(const FrameReport& report);

/// What a click asks for.
struct ObjectWish {
  std::optional<Eigen::Vector2d> place;  ///< of the object that is felt from now on; none: let go
  uint32_t object = 0;                   ///< the one that was clicked
};

/// The left button chooses what it is pressed on; on the object that was chosen, it lets go. Where
/// no object is, and while the picture is touched, the button is the hand's.
class ObjectClick {
 public:
  /// `picture` is the part of the window that shows the visible part of the frame. Nothing when
  /// nobody clicked on an object.
  std::optional<ObjectWish> update(const Mouse& mouse, const Rect& picture,
                                   const FrameReport& report);
  /// The button is still down since then.
  bool holds() const { return holds_; }

 private:
  bool was_down_ = false;
  bool holds_ = false;
};

}  // namespace spidar
