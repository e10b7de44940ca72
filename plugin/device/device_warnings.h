// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
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

/// Posts a warning on the bus for each problem of an element's device, each once per stream. Use it
/// in the streaming thread; call start() before. Without a device, sessions are null.
class DeviceWarnings {
 public:
  /// `what` is the subject of "… continues without it.", for example "The video".
  DeviceWarnings(GstElement* element, std::string what)
      : element_(element), what_(std::move(what)) {}

  /// Opens a device by calling `opens`, which returns why the haptic trace cannot be written, or an
  /// empty string. Reports the result. Returns false when the stream must not begin.
  bool open(HapticOutput& output, const std::string& device, OnDeviceError policy,
            const std::function<std::string()>& opens);
  /// Call this when the element starts: every warning may be posted again.
  void start();
  /// Checks the device. Returns false when the stream must end, and then reports why.
  bool check(const HapticSession* session, OnDeviceError policy);
  void report_haptic_trace(const std::string& error);
  /// Reports, once for each device, that the haptic trace can no longer be written.
  void check_haptic_trace(const HapticSession* session);
  /// Writes the last rows of the haptic trace at the end of a stream. Reports as
  /// check_haptic_trace() does, or how many rows are missing.
  void end_haptic_trace(HapticSession* session);

 private:
  bool check_refused(const std::string& device, const std::exception& refusal, OnDeviceError policy,
                     SourceLocation location = SourceLocation::here()) const;
  /// Also posts an information message if "auto" has chosen the device or the device renders only a
  /// part of the picture's motion, and a warning of a doubtful profile.
  void check_opened(const HapticOutput& output) const;
  void post(const char* state, const std::string& device, const std::string& why) const;
  void check_strings(const LoopSnapshot& loop);
  void check_pose(const LoopSnapshot& loop, bool has_strings);
  void check_force(const LoopSnapshot& loop);
  void check_late(const LoopSnapshot& loop);
  void check_remarks(const HapticSession& session);
  void check_refusal(const HapticSession& session);

  GstElement* const element_;
  const std::string what_;
  std::string profile_;     ///< the name of the device's profile
  guint strings_ = 0;       ///< bit i: string i
  bool pose_lost_ = false;  ///< the warning was posted, and the pose has not come back since
  bool held_back_ = false;  ///< this and the next four: the warning was posted
  bool vibrated_ = false;
  bool shaken_ = false;
  bool late_ = false;
  bool remarked_ = false;
  int64_t late_from_ns_ = 0;
  bool haptic_trace_ = false;
  DeviceState state_ = DeviceState::kClosed;
  std::string refusal_;  ///< the posted reason why a lost device is refused
  uint64_t times_lost_ = 0;
};

/// Warns of the number of missing rows in `trace`, such as "The trace", unless the number is 0.
void warn_of_missing_rows(GstElement* element, const char* trace, uint64_t rows);

}  // namespace spidar
