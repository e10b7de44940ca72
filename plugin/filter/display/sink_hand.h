// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <mutex>
#include <optional>

#include "plugin/device/haptic_output.h"
#include "plugin/filter/choice/sink_mouse.h"
#include "plugin/frame/frame_report.h"
#include "plugin/window/view/mouse_hand.h"

namespace spidar::filter {

/// While the picture is touched, the mouse in the window of a video sink leads the simulated hand,
/// as the mouse in the debug window does, see window::MouseHand. Thread-safe.
class SinkHand {
 public:
  explicit SinkHand(HapticOutput& output) : output_(output) {}

  /// Call this for each frame of `width` × `height` pixels.
  void update(const FrameReport& report, int width, int height) {
    if (!report.analyzed) return;
    const bool touched = report.touch.on && width > 0 && height > 0;
    if (!touched) return release();
    const std::lock_guard<std::mutex> lock(mutex_);
    touched_ = true;
    pointer_ = report.touch.pointer;
    const double w = width, h = height;
    const PicturePart& part = report.visible;
    picture_ = {part.x / w, part.y / h, part.width / w, part.height / h};
  }
  /// Returns false without a hand to lead: nothing is touched, or the device is not simulated.
  bool update(const SinkMouse& mouse) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!touched_) return false;
    mouse_.at_px = mouse.position;
    mouse_.shift = mouse.shift;
    mouse_.wheel = mouse.wheel;
    if (mouse.act == SinkMouse::Act::kPress) mouse_.down = true;
    if (mouse.act == SinkMouse::Act::kRelease) mouse_.down = false;
    return output_.lead_hand(hand_.update(mouse_, picture_, pointer_));
  }
  void release() {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!touched_) return;
    touched_ = mouse_.down = false;
    hand_.release();
    output_.lead_hand(std::nullopt);
  }

 private:
  HapticOutput& output_;
  std::mutex mutex_;
  bool touched_ = false;
  GripPointer pointer_;
  window::Rect picture_;  ///< the touched part, as fractions of the frame
  window::Mouse mouse_;   ///< its position is a fraction of the frame
  window::MouseHand hand_;
};

}  // namespace spidar::filter
