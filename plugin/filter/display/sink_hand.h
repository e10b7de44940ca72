// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The mouse in the window of a video sink as the hand of the simulated device.
#pragma once

#include <mutex>

#include "plugin/filter/choice/sink_mouse.h"
#include "plugin/filter/frame/frame_report.h"
#include "plugin/output/haptic_output.h"
#include "plugin/window/view/mouse_hand.h"

namespace spidar {

/// While the picture is touched, the mouse leads the hand as in the debug window, see MouseHand.
/// Thread-safe.
class SinkHand {
 public:
  explicit SinkHand(HapticOutput& output) : output_(output) {}

  /// Of each frame, which is `width` × `height` pixels large.
  void see(const FrameReport& report, int width, int height);
  /// False when there is no hand to lead: nothing is touched, or the device is not simulated.
  bool take(const SinkMouse& mouse);
  void let_go();

 private:
  HapticOutput& output_;
  std::mutex mutex_;
  bool touched_ = false;
  TouchMap map_;
  Rect picture_;  ///< what is touched, as shares of the frame
  Mouse mouse_;   ///< its place is a share of the frame, too
  MouseHand hand_;
};

}  // namespace spidar
