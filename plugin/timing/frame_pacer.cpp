// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/timing/frame_pacer.h"

#include <algorithm>
#include <cmath>

#include "core/motion/image_motion.h"
#include "plugin/timing/instant_rate.h"

namespace spidar {
namespace {

/// The shortest plausible interval between frames: an eighth of the interval in the caps, within
/// limits. If two frames are closer together, one of their timestamps is wrong, and a motion must
/// not be divided by the difference.
int64_t least_interval_ns(const GstVideoInfo& info, double rate) {
  constexpr double kMax_ns = 5e6;
  if (info.fps_n <= 0) return kMinInterval_ns;
  const double nominal_ns = 1e9 * info.fps_d / info.fps_n / std::fabs(rate);
  return std::max(kMinInterval_ns, static_cast<int64_t>(std::min(nominal_ns / 8, kMax_ns)));
}

}  // namespace

GstClockTime nominal_duration(const GstVideoInfo& info) {
  return info.fps_n > 0 ? gst_util_uint64_scale_int(GST_SECOND, info.fps_d, info.fps_n) : 0;
}

std::optional<FrameStamp> stamp_of(GstBuffer* buffer, GstClockTime nominal,
                                   const GstSegment& segment, uint32_t epoch) {
  const GstClockTime pts = GST_BUFFER_PTS(buffer);
  GstClockTime duration = GST_BUFFER_DURATION(buffer);
  if (!GST_CLOCK_TIME_IS_VALID(duration) && nominal > 0) duration = nominal;
  const bool has_end = GST_CLOCK_TIME_IS_VALID(duration) && duration < GST_CLOCK_TIME_NONE - pts;
  const GstClockTime end = has_end ? pts + duration : GST_CLOCK_TIME_NONE;
  guint64 from = 0, to = 0;
  if (!gst_segment_clip(&segment, GST_FORMAT_TIME, pts, end, &from, &to)) return std::nullopt;
  const GstClockTime shown = gst_segment_to_running_time(&segment, GST_FORMAT_TIME,
                                                         segment.rate < 0 && has_end ? to : from);
  if (!GST_CLOCK_TIME_IS_VALID(shown)) return std::nullopt;
  FrameStamp stamp;
  stamp.epoch = epoch;
  stamp.stream_ns =
      static_cast<int64_t>(gst_segment_to_stream_time(&segment, GST_FORMAT_TIME, from));
  stamp.running_ns = static_cast<int64_t>(shown);
  stamp.length_ns = has_end ? static_cast<int64_t>(to - from) : 0;
  stamp.rate = segment.rate;
  return stamp;
}

FramePacer::Order FramePacer::order(int64_t running_ns, const GstVideoFrame& frame,
                                    const GstSegment& segment) const {
  // In reverse playback, sources and decoders mark every buffer, or the first of every group.
  if (GST_BUFFER_IS_DISCONT(frame.buffer) && segment.rate > 0) return Order::kFirst;
  if (last_running_ns_ >= 0 && running_ns >= last_running_ns_ &&
      running_ns - last_running_ns_ < least_interval_ns(frame.info, segment.rate)) {
    // After an accurate seek, the segment may contain hardly any of its first frame.
    return frames_in_segment_ > 1 ? Order::kTooSoon : Order::kFirst;
  }
  return running_ns < last_running_ns_ ? Order::kFalling : Order::kNext;
}

PacedTime FramePacer::at(int64_t running_ns, double rate_multiplier) const {
  PacedTime time;
  time.running_ns = time.paced_ns = running_ns;
  time.in_place = running_ns == last_running_ns_;
  if (last_running_ns_ < 0) return time;
  const double since_ns = static_cast<double>(running_ns - last_running_ns_) / rate_multiplier;
  const double paced_ns = static_cast<double>(last_paced_ns_) + since_ns;
  if (std::fabs(paced_ns) <= static_cast<double>(kLatest_ns)) {  // otherwise it starts again
    time.paced_ns = last_paced_ns_ + std::llround(since_ns);
  }
  time.since_ns = time.paced_ns - last_paced_ns_;
  return time;
}

void FramePacer::push(const PacedTime& time, bool moved) {
  advance(time);
  ++frames_in_segment_;
  if (moved && time.since_ns > 0) last_interval_ns_ = time.since_ns;
}

void FramePacer::advance(const PacedTime& time) {
  last_running_ns_ = time.running_ns;
  last_paced_ns_ = time.paced_ns;
}

void FramePacer::reset() {
  last_running_ns_ = -1;
  frames_in_segment_ = 0;
  last_interval_ns_ = 0;
}

int64_t FramePacer::next_ns() const {
  return last_running_ns_ + std::max<int64_t>(last_interval_ns_, 1);
}

}  // namespace spidar
