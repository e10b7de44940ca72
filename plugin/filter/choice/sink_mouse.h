// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The mouse in the window of a video sink.
#pragma once

#include <optional>

#include <Eigen/Core>
#include <gst/gst.h>

namespace spidar {

/// One thing that the mouse did.
struct SinkMouse {
  enum class Act { kMove, kPress, kRelease, kWheel };  ///< the button is the left one
  Act act = Act::kMove;
  /// Of the frame before it is turned: (0, 0) is its top left corner.
  Eigen::Vector2d place{0.5, 0.5};
  bool shift = false;  ///< Shift key
  double wheel = 0;    ///< notches, > 0 away from the user
};

/// What an event says that comes from downstream: elements that scale, crop or turn the picture
/// have converted it to pixels of the frame. `source` is the pad that it comes to, whose caps are
/// those of the frames. Nothing for other events and buttons.
std::optional<SinkMouse> read_mouse(GstEvent* event, GstPad* source);

}  // namespace spidar
