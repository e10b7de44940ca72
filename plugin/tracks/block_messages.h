// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What a sink of haptic tracks reports on the bus.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include <gst/gst.h>

#include "core/force/motion_rendering.h"
#include "core/track/track_format.h"
#include "plugin/frame/motion_message.h"
#include "plugin/frame/no_force_watch.h"
#include "plugin/tracks/sidecar.h"

namespace spidar {

/// Posts for each block of samples what spidarmotion posts for a frame. Streaming thread; lives as
/// long as the element, which its messages hold.
class BlockMessages {
 public:
  explicit BlockMessages(GstElement* element) : element_(element) {}

  /// Another stream comes to this pad: its file is the track or, where there is none, the element.
  void begin_stream(GstPad* sink) {
    const std::string file = film_of(sink);
    track_ = std::make_shared<const std::string>(file.empty() ? GST_OBJECT_NAME(element_) : file);
  }

  /// `loop` is nothing while no device is open.
  void post(const TrackBlock& block, const GstSegment& segment,
            const std::optional<LoopSnapshot>& loop, bool muted) {
    const auto begin = static_cast<guint64>(block.begin_ns);
    const guint64 pts = gst_segment_position_from_running_time(&segment, GST_FORMAT_TIME, begin);
    FrameReport report;
    report.track = track_;
    report.frame.stamp.running_ns = block.begin_ns;
    report.frame.stamp.stream_ns =
        static_cast<int64_t>(gst_segment_to_stream_time(&segment, GST_FORMAT_TIME, pts));
    for (size_t i = 0; i < block.count; ++i) {
      const Wrench wrench = to_wrench(block.samples[i]);
      if (size_N(wrench) > size_N(report.frame.wrench)) report.frame.wrench = wrench;
    }
    report.no_force = reason_in_track(report.frame.wrench, loop);
    report.device_no_force = loop ? reason_in_device(*loop, muted) : NoForceReason::kNoDevice;
    post_motion_message(element_, pts, static_cast<GstClockTime>(block.duration_ns), report,
                        &unread_);
  }

 private:
  GstElement* const element_;
  std::shared_ptr<const std::string> track_ = std::make_shared<const std::string>();
  gint unread_ = 0;  // atomic
};

}  // namespace spidar
