// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// When each frame is shown, and whether that can be analysed.
#pragma once

#include <cstdint>
#include <optional>

#include <gst/video/video.h>

#include "core/analysis/frame.h"

namespace spidar {

/// GST_CLOCK_TIME_NONE when the segment is not in time format, as from a file source without a
/// parser.
inline GstClockTime running_time_of(const GstSegment& segment, GstClockTime time) {
  return segment.format == GST_FORMAT_TIME
             ? gst_segment_to_running_time(&segment, GST_FORMAT_TIME, time)
             : GST_CLOCK_TIME_NONE;
}
inline GstClockTime stream_time_of(const GstSegment& segment, GstClockTime time) {
  return segment.format == GST_FORMAT_TIME
             ? gst_segment_to_stream_time(&segment, GST_FORMAT_TIME, time)
             : GST_CLOCK_TIME_NONE;
}

/// As the caps state it; 0 where they do not.
GstClockTime nominal_duration(const GstVideoInfo& info);

/// When a sink shows a buffer that lasts for `nominal`, unless it says for how long, and where that
/// is in the film. Nothing when the sink drops it. The segment is in time format, and the buffer
/// has a PTS.
std::optional<FrameStamp> stamp_of(GstBuffer* buffer, GstClockTime nominal,
                                   const GstSegment& segment, uint32_t epoch);

/// Where a frame lies on the time of the analysis.
struct PacedTime {
  int64_t running_ns = 0;  ///< of the element
  int64_t paced_ns = 0;    ///< the distance to the frame before is that of showing them
  int64_t since_ns = 0;    ///< paced, since the frame before; 0 when there is none
  bool in_place = false;   ///< of the frame before, which has the same time
};

/// Follows the timestamps of one stream. Streaming thread.
class FramePacer {
 public:
  enum class Order {
    kNext,   ///< after the frame before
    kFirst,  ///< the frame before does not count: a discontinuity, or next to nothing is left of it
    kTooSoon,  ///< the same time as the frame before, or nearly so: no Δt to divide a motion by
    kFalling,  ///< before the frame before
  };

  Order order(int64_t running_ns, const GstVideoFrame& frame, const GstSegment& segment) const;
  /// `rate_multiplier` as InstantRate has it.
  PacedTime at(int64_t running_ns, double rate_multiplier) const;

  /// A frame was analysed; `moved` when something was measured since the frame before.
  void push(const PacedTime& time, bool moved);
  /// A frame was passed that has no picture.
  void advance(const PacedTime& time);
  void begin_segment() { frames_in_segment_ = 0; }
  /// Running time begins anew.
  void reset();

  bool has_frame() const { return last_running_ns_ >= 0; }
  /// When the next frame would be due, one like the last ones.
  int64_t next_ns() const;

 private:
  int64_t last_running_ns_ = -1;
  uint64_t frames_in_segment_ = 0;
  int64_t last_paced_ns_ = 0;
  int64_t last_interval_ns_ = 0;
};

}  // namespace spidar
