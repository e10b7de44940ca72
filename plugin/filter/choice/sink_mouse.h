// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The mouse in the window of a video sink: what it did, and where it points at the picture.
#pragma once

#include <mutex>
#include <optional>

#include <Eigen/Core>
#include <gst/gst.h>

#include "core/choice/object_choice.h"

namespace spidar::filter {

/// One action of the mouse.
struct SinkMouse {
  enum class Act { kMove, kPress, kRelease, kWheel };  ///< the button is the left one
  Act act = Act::kMove;
  /// In the frame before it is turned: (0, 0) is its top left corner, (1, 1) its bottom right one.
  Eigen::Vector2d position{0.5, 0.5};
  bool shift = false;  ///< Shift key
  double wheel = 0;    ///< notches, > 0 away from the user
};

/// The content of an event that comes from downstream: elements that scale, crop or turn the
/// picture have converted it to pixels of the frame. `source` is the pad that the event comes to,
/// whose caps are those of the frames. Nothing for other events and buttons.
std::optional<SinkMouse> read_mouse(GstEvent* event, GstPad* source);

/// Moving the mouse points at an object; a click of the left button keeps the one there, or lets go
/// of the one that is kept. Thread-safe.
class MousePointer {
 public:
  void update(const SinkMouse& mouse);

  /// The position in the frame before it is turned, as SinkMouse::position. Nothing before the
  /// mouse was seen.
  std::optional<Eigen::Vector2d> position() const;
  /// The click whose object is kept, with its position in the frame before it is turned.
  KeptObject kept() const;

  /// Keeps the object at this position, or none, without a mouse in the window of a sink.
  void keep(const std::optional<Eigen::Vector2d>& position);

  /// Stops keeping the object of this click.
  void let_go(uint32_t click);
  /// Forgets the mouse.
  void reset();

 private:
  mutable std::mutex mutex_;
  std::optional<Eigen::Vector2d> position_;
  uint32_t clicks_ = 0;
  KeptObject kept_;  ///< its position is that of the frame before it is turned
};

}  // namespace spidar::filter
