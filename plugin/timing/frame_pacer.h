// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstdint>
#include <optional>

#include <gst/video/video.h>

namespace spidar {

/// Returns GST_CLOCK_TIME_NONE when the segment is not in time format, as from a file source
/// without a parser.
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

/// When a frame is shown, and in which run of its film.
struct FrameStamp {
  /// Counts the runs of playback: a frame of another run does not continue the previous frame. A
  /// seek of any length, another film and another rate begin a run; a gap in the film does not.
  uint32_t epoch = 0;
  int64_t stream_ns = -1;   ///< position of the shown part in the film; −1: unknown
  int64_t running_ns = -1;  ///< when that part is shown; backwards, its end; −1: unknown
  int64_t length_ns = 0;    ///< how much stream time is shown; 0: unknown
  double rate = 1;          ///< stream time over running time; negative: backwards
};

/// The duration of a frame at the frame rate of the caps; 0 when they have none.
GstClockTime nominal_duration(const GstVideoInfo& info);

/// When a sink shows a buffer, and where the buffer is in the film; nothing when the sink drops the
/// buffer. A buffer without a duration lasts for `nominal`. The segment is in time format, and the
/// buffer has a PTS.
std::optional<FrameStamp> stamp_of(GstBuffer* buffer, GstClockTime nominal,
                                   const GstSegment& segment, uint32_t epoch);

/// The time of a frame on the time line of the analysis.
struct PacedTime {
  int64_t running_ns = 0;  ///< at the element
  int64_t paced_ns = 0;    ///< advances by the interval at which frames are shown
  int64_t since_ns = 0;    ///< paced_ns since the previous frame; 0 when there is none
  bool in_place = false;   ///< replaces the previous frame, which has the same time
};

/// Follows the timestamps of a stream, and decides which frames can be analysed. Streaming thread.
class FramePacer {
 public:
  enum class Order {
    kNext,     ///< after the previous frame
    kFirst,    ///< the previous frame does not count: a discontinuity, or hardly any of it remains
    kTooSoon,  ///< as the previous frame, or nearly so: no Δt to divide by
    kFalling,  ///< before the previous frame
  };

  Order order(int64_t running_ns, const GstVideoFrame& frame, const GstSegment& segment) const;
  /// `rate_multiplier` is InstantRate::multiplier().
  PacedTime at(int64_t running_ns, double rate_multiplier) const;

  /// Call this after a frame was analysed. `moved`: it has a motion since the previous frame.
  void push(const PacedTime& time, bool moved);
  /// Call this for a frame without a picture.
  void advance(const PacedTime& time);
  void begin_segment() { frames_in_segment_ = 0; }
  /// Call this when running time restarts.
  void reset();

  bool has_frame() const { return last_running_ns_ >= 0; }
  /// The running time at which the next frame is due if the interval stays the same.
  int64_t next_ns() const;

 private:
  int64_t last_running_ns_ = -1;
  uint64_t frames_in_segment_ = 0;
  int64_t last_paced_ns_ = 0;
  int64_t last_interval_ns_ = 0;
};

}  // namespace spidar
