// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The mouse in the window of a video sink as a pointer on the picture.
#pragma once

#include <mutex>
#include <optional>

#include <Eigen/Core>
#include <gst/gst.h>

#include "core/choice/chosen.h"
#include "core/picture_turn.h"

namespace spidar {

/// Sinks send moves and clicks upstream, and elements that scale, crop or turn the picture convert
/// them: here they are in pixels of the frame. Thread-safe.
class MousePointer {
 public:
  /// An event that comes from downstream. `source` is the pad that it comes to, whose caps are
  /// those of the frames. Events other than moves and clicks of the left button are nothing.
  void take(GstEvent* event, GstPad* source);

  /// Of the frame before it is turned: (0, 0) is its top left corner. Nothing before the mouse was
  /// seen.
  std::optional<Eigen::Vector2d> place() const;
  /// What a click keeps until the next one.
  KeptObject kept(const PictureTurn& turn) const;

  /// Keeps what is at this place, or nothing, without a mouse in the window of a sink.
  void keep(const std::optional<Eigen::Vector2d>& place);

  /// The object of this click is not kept any more.
  void let_go(uint32_t click);
  /// Forgets the mouse.
  void reset();

 private:
  mutable std::mutex mutex_;
  std::optional<Eigen::Vector2d> place_;
  uint32_t clicks_ = 0;
  KeptObject kept_;  ///< its place is that of the frame before it is turned
};

}  // namespace spidar
