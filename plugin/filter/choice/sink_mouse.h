// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <mutex>
#include <optional>

#include <Eigen/Core>
#include <gst/gst.h>

#include "core/choice/object_choice.h"

namespace spidar::filter {

/// One action of the mouse in the window of a video sink.
struct SinkMouse {
  enum class Act { kMove, kPress, kRelease, kWheel };  ///< press and release: left button
  Act act = Act::kMove;
  /// In the frame before it is turned: (0, 0) is the top left corner, (1, 1) the bottom right one.
  Eigen::Vector2d position{0.5, 0.5};
  bool shift = false;  ///< Shift key
  double wheel = 0;    ///< notches, positive away from the user
};

/// Parses a mouse event from downstream. Elements that scale, crop or turn the picture have already
/// converted its position to pixels of the frame. `source` is the pad that receives the event; its
/// caps are those of the frames. Returns nothing for other events and buttons.
std::optional<SinkMouse> read_mouse(GstEvent* event, GstPad* source);

/// Follows the mouse: a move points at an object; a click of the left button keeps the object
/// there, or releases the kept one. Thread-safe.
class MousePointer {
 public:
  void update(const SinkMouse& mouse);

  /// The position in the frame before it is turned, as SinkMouse::position. Returns nothing before
  /// the mouse was seen.
  std::optional<Eigen::Vector2d> position() const;
  /// The click whose object is kept, with its position in the frame before it is turned.
  KeptObject kept() const;

  /// Keeps the object at `position`, or none if empty, for clicks outside the window of a sink.
  void keep(const std::optional<Eigen::Vector2d>& position);

  /// Stops keeping the object of this click.
  void release(uint32_t click);
  void reset();

 private:
  mutable std::mutex mutex_;
  std::optional<Eigen::Vector2d> position_;
  uint32_t clicks_ = 0;
  KeptObject kept_;  ///< its position is in the frame before it is turned
};

}  // namespace spidar::filter
