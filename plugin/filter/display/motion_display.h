// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <chrono>
#include <memory>
#include <mutex>
#include <string>

#include <gst/video/video.h>

#include "plugin/device/haptic_output.h"
#include "plugin/filter/choice/motion_choice.h"
#include "plugin/filter/display/sink_hand.h"
#include "plugin/frame/point_owners.h"
#include "plugin/gobject/unread_messages.h"
#include "plugin/overlay/video_overlay.h"
#include "plugin/properties/motion_properties.h"
#include "plugin/reasons/no_force.h"
#include "plugin/window/window.h"

namespace spidar::filter {

/// One element's overlay, meta and debug window, which show the motion and force of a frame.
class MotionDisplay {
 public:
  /// The other arguments belong to `element` and live as long.
  MotionDisplay(GstElement* element, HapticOutput& output, const NoForceWatch& no_force,
                MotionChoice& choice, UnreadMessages& unread)
      : element_(element),
        output_(output),
        no_force_(no_force),
        choice_(choice),
        unread_(unread),
        hand_(output) {}

  // --- streaming thread

  /// Shows `report`, the result for `frame`. The overlay needs a frame that is mapped for writing,
  /// the metas need a writable buffer; without these, they are left out.
  void show(const FrameReport& report, const FrameSettings& settings, GstVideoFrame& frame);

  /// Call this instead of show() for a frame that was not processed.
  void reset() { owners_.reset(); }

  /// Begins another stream, which comes from the file `film`, or from no file if `film` is empty.
  void begin_stream(const std::string& film);
  /// Call this at the start of each segment: other elements may be linked by then.
  void begin_segment();

  // --- any thread

  /// The hand that the mouse of a sink leads.
  SinkHand& hand() { return hand_; }
  std::shared_ptr<window::Source> source() const;
  void open_window();
  /// Closes the window, and waits for that for Window::kCloseTimeout at most.
  void close_window();
  /// For tests and save_window(); null while there is no window.
  std::shared_ptr<window::Window> window() const;
  /// Writes the picture of the window to a PNG file. Returns an empty string, or why that fails.
  std::string save_window(const std::string& path);

 private:
  DrawnFrame drawn(const FrameReport& report, const AnalyzerSettings& settings);
  void follow_film(const FrameReport& report);

  GstElement* const element_;
  HapticOutput& output_;
  const NoForceWatch& no_force_;
  MotionChoice& choice_;
  UnreadMessages& unread_;
  SinkHand hand_;
  // Streaming thread.
  PointOwners owners_;
  ForceCurve curve_;  ///< for the overlay
  bool has_subtitles_ = false;
  FilmScene film_;  ///< for the window
  uint32_t epoch_ = 0;

  mutable std::mutex mutex_;  ///< not held while a window opens or closes
  std::shared_ptr<window::Window> window_;
};

}  // namespace spidar::filter
