// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <exception>
#include <string>
#include <utility>

#include <gst/gst.h>

#include "plugin/device/device_warnings.h"
#include "plugin/device/haptic_output.h"
#include "plugin/frame/frame_report.h"
#include "plugin/gobject/bus_messages.h"
#include "plugin/properties/motion_properties.h"

namespace spidar::filter {

/// Posts a warning on the bus for each problem that does not stop the video, each once per stream.
/// Use it in the streaming thread; call start() before that thread runs.
class BusWarnings {
 public:
  explicit BusWarnings(GstElement* element) : element_(element), device_(element, "The video") {}

  /// Call this when the element starts: every warning may be posted again.
  void start();
  /// Call this when a stream begins: all warnings except trace and device may be posted again.
  void begin_stream() {
    frame_faults_ = 0;
    exception_ = false;
    touch_track_ = touch_device_ = stiffness_ = pointer_ = false;
  }

  /// Warns if the element is in an editing timeline, whose clips have their own running times.
  void check_bins();
  void check_frame(const FrameReport& report);
  /// Calls `function`. An unexpected exception must not stop the video: if `function` throws, posts
  /// a warning (once per stream) and returns false. `doing` completes "while …" in the debug text.
  template <typename Function>
  bool guard(const char* doing, Function&& function,
             SourceLocation location = SourceLocation::here()) {
    try {
      function();
      return true;
    } catch (const std::exception& error) {
      if (!std::exchange(exception_, true)) {
        post_exception(element_, GST_MESSAGE_WARNING, error,
                       std::string("while ") + doing + "; the video goes on", location);
      }
      return false;
    }
  }
  /// Warns once when the trace can no longer be written. `error` is errno, or 0 if there is none.
  void check_trace(int error);
  void check_touch(const HapticOutput& output, const FrameReport& report,
                   const TouchProperties& wanted);
  /// Warns if the grip points but the device does not measure its position.
  void check_pointer(const HapticSession* session);
  DeviceWarnings& device() { return device_; }

 private:
  GstElement* const element_;
  guint frame_faults_ = 0;  ///< bit i: FrameReport::Fault i was reported
  // Whether each of these warnings was posted.
  bool touch_track_ = false, touch_device_ = false, stiffness_ = false, pointer_ = false;
  bool trace_ = false, exception_ = false;
  DeviceWarnings device_;
};

/// Returns why a frame is not analysed, for the log.
const char* fault_text(FrameReport::Fault fault);

}  // namespace spidar::filter
