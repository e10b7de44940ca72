// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Reports on the bus when something is wrong with an element's device.
#pragma once

#include <exception>
#include <functional>
#include <string>

#include <gst/gst.h>

#include "core/fields.h"
#include "plugin/device/haptic_output.h"

namespace spidar {

enum class OnDeviceError { kWarn, kError };

/// The fields of the message `spidar-device`: `state` is opened, refused, lost or back.
void device_message_fields(const char* state, const std::string& device, const std::string& why,
                           FieldSink& to);

/// Posts each warning once per stream. Streaming thread, and start() before it. Sessions are null
/// while the element has no device.
class DeviceWarnings {
 public:
  /// `what` goes on without the device: "The video".
  DeviceWarnings(GstElement* element, std::string what)
      : element_(element), what_(std::move(what)) {}

  /// Opens a device by calling `opens`, which returns why the haptic trace cannot be written, or an
  /// empty string; reports the result. Returns false when the stream must not begin without
  /// `device`.
  bool open(HapticOutput& output, const std::string& device, OnDeviceError policy,
            const std::function<std::string()>& opens);
  /// The element starts: everything may be reported again.
  void start();
  /// Checks the device. Returns false when the stream has to end, and then reports why.
  bool check(const HapticSession* session, OnDeviceError policy);
  /// Reports what HapticOutput::begin_trace() has returned.
  void report_haptic_trace(const std::string& error);
  /// Reports, once for each device, that the haptic trace can no longer be written.
  void check_haptic_trace(const HapticSession* session);
  /// The stream ends: writes the last rows of the haptic trace, reports as check_haptic_trace()
  /// does, or how many rows are missing.
  void end_haptic_trace(HapticSession* session);

 private:
  bool check_refused(const std::string& device, const std::exception& refusal, OnDeviceError policy,
                     SourceLocation location = SourceLocation::here()) const;
  /// Posts an information message, too, if "auto" has chosen the device, or it renders only a part
  /// of what is to be seen in the picture; and a warning of a profile that is in doubt.
  void check_opened(const HapticOutput& output) const;
  /// Posts the message `spidar-device`.
  void post(const char* state, const std::string& device, const std::string& why) const;
  void check_strings(const LoopSnapshot& loop);
  void check_pose(const LoopSnapshot& loop, bool has_strings);
  void check_force(const LoopSnapshot& loop);
  void check_late(const LoopSnapshot& loop);
  void check_remarks(const HapticSession& session);
  void check_refusal(const HapticSession& session);

  GstElement* const element_;
  const std::string what_;
  std::string profile_;     ///< of the device, its name
  guint strings_ = 0;       ///< bit i: string i
  bool pose_lost_ = false;  ///< reported, and not come back since
  bool held_back_ = false;  ///< reported
  bool vibrated_ = false;   ///< reported
  bool shaken_ = false;     ///< reported
  bool late_ = false;       ///< reported
  bool remarked_ = false;   ///< reported
  int64_t late_from_ns_ = 0;
  bool haptic_trace_ = false;
  DeviceState state_ = DeviceState::kClosed;
  std::string refusal_;  ///< reported of a device that is lost
  uint64_t times_lost_ = 0;
};

/// Warns of the number of rows that are missing in `trace`, such as "The trace", unless it is 0.
void warn_of_missing_rows(GstElement* element, const char* trace, uint64_t rows);

}  // namespace spidar
