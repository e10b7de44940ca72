// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/depth/depth_match.h"

#include <algorithm>

#include "plugin/timing/instant_rate.h"

namespace spidar {
namespace {

std::optional<gint64> running_time(const GstSegment& segment, GstClockTime time) {
  guint64 magnitude = 0;
  if (!GST_CLOCK_TIME_IS_VALID(time)) return {};
  const int sign = gst_segment_to_running_time_full(&segment, GST_FORMAT_TIME, time, &magnitude);
  if (sign == 0 || !is_time(magnitude)) return {};
  return sign * static_cast<gint64>(magnitude);
}

}  // namespace

std::optional<ShownTime> shown_time(const GstSegment& segment, GstBuffer* buffer,
                                    GstClockTime frame_ns) {
  if (segment.format != GST_FORMAT_TIME) return {};
  const std::optional<gint64> begin = running_time(segment, GST_BUFFER_PTS(buffer));
  if (!begin) return {};
  GstClockTime length = GST_BUFFER_DURATION(buffer);
  if (!GST_CLOCK_TIME_IS_VALID(length)) length = frame_ns;
  const gint64 end = is_time(length)
                         ? running_time(segment, GST_BUFFER_PTS(buffer) + length).value_or(*begin)
                         : *begin;
  // In reverse playback the end of a frame has the smaller running time.
  return ShownTime{std::min(*begin, end), std::max(*begin, end)};
}

bool DepthMatch::settled(const ShownTime& frame) {
  const gint64 half_ns = frame.length_ns() / 2;
  if (next_) {
    const gint64 other_ns = next_->time.length_ns() / 2;
    const gint64 early_ns = other_ns > 0 ? std::min(half_ns, other_ns) : half_ns;
    if (next_->time.start_ns > frame.start_ns + early_ns) return true;
    held_ = std::move(next_);
    next_.reset();
  }
  const gint64 latest_ns = frame.start_ns + half_ns;
  return finished_ || known_until_ns_ > latest_ns || (held_ && held_->time.end_ns > latest_ns);
}

const DepthImage* DepthMatch::find(const ShownTime& frame, guint64 max_age_ns) const {
  if (!held_) return nullptr;
  const ShownTime& time = held_->time;
  // Rejects images whose time does not match the frame: an image from before a seek may be far off
  // in either direction.
  if (time.start_ns > frame.start_ns + frame.length_ns() / 2) return nullptr;
  const gint64 age_ns = frame.start_ns - time.end_ns;
  if (age_ns >= 0 && static_cast<guint64>(age_ns) > max_age_ns) return nullptr;
  return &*held_;
}

}  // namespace spidar
