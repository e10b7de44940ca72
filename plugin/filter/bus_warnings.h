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

/// Reports on the bus when something is wrong that does not stop the video, each warning once per
/// stream. Streaming thread, and start() before it.
class BusWarnings {
 public:
  explicit BusWarnings(GstElement* element) : element_(element), device_(element, "The video") {}

  /// Tells that the element starts, so that every warning may be posted again.
  void start();
  /// Tells that another stream begins, so that faults of frames may be reported again.
  void begin_stream() {
    frame_faults_ = 0;
    exception_ = false;
    touch_track_ = touch_device_ = stiffness_ = pointer_ = false;
  }

  /// Checks the bins around the element, which may have a running time of their own.
  void check_bins();
  void check_frame(const FrameReport& report);
  /// Calls `function`. When it throws, reports that once, and returns false: an unforeseen
  /// exception does not end a film. `doing` completes "while …" in the debug text.
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
  /// Reports once that the trace can no longer be written. `error` is errno, or 0 when all is well.
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
const char* words_of(FrameReport::Fault fault);

}  // namespace spidar::filter
