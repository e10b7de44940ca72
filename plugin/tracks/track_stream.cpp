// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tracks/track_stream.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "plugin/gobject/category.h"
#include "plugin/timing/instant_rate.h"
#include "plugin/tracks/track_tags.h"

#undef GST_CAT_DEFAULT
#define GST_CAT_DEFAULT spidar::category_of(GST_PAD_PARENT(pad_))

namespace spidar::tracks {
namespace {

constexpr size_t kBufferSamples = Stream::kBuffer_ns / kTrackPeriod_ns;

/// Returns a forward segment whose time is the running time of `video`.
GstSegment running_segment(const GstSegment& video) {
  GstSegment segment;
  gst_segment_init(&segment, GST_FORMAT_TIME);
  segment.flags = video.flags;
  segment.start = segment.base = segment.position = video.base;
  segment.time = gst_segment_to_stream_time(
      &video, GST_FORMAT_TIME,
      gst_segment_position_from_running_time(&video, GST_FORMAT_TIME, video.base));
  segment.applied_rate = video.rate * video.applied_rate;
  return segment;
}

/// Whether a running time has the same stream time in both.
bool is_continued(const GstSegment& a, const GstSegment& b) {
  return a.format == b.format && a.flags == b.flags && a.applied_rate == b.applied_rate &&
         gst_segment_to_stream_time(&a, a.format, b.start) == b.time;
}

int64_t signed_ns(GstClockTime time) {
  return static_cast<int64_t>(time);
}

}  // namespace

Stream::Stream(GstPad* pad) : pad_(pad) {
  reset();
}

Stream::~Stream() {
  flush();
}

void Stream::begin_stream(GstElement* element, const GstEvent* stream_start) {
  // gst_event_parse_*() take non-const events, but do not change them.
  auto* const given = const_cast<GstEvent*>(stream_start);
  g_autofree gchar* id = gst_pad_create_stream_id(pad_, element, "wrench");
  GstEvent* const event = gst_event_new_stream_start(id);
  guint group;
  if (gst_event_parse_group_id(given, &group)) gst_event_set_group_id(event, group);
  gst_event_set_seqnum(event, gst_event_get_seqnum(given));
  gst_pad_push_event(pad_, event);
  negotiated_ = false;
  gst_segment_init(&sent_, GST_FORMAT_UNDEFINED);
}

bool Stream::negotiate() {
  if (negotiated_ && !gst_pad_check_reconfigure(pad_)) return true;
  GstCaps* caps = gst_pad_get_allowed_caps(pad_);
  if (!caps) caps = gst_pad_get_pad_template_caps(pad_);
  if (gst_caps_is_empty(caps)) {
    gst_caps_unref(caps);
    return false;
  }
  caps = gst_caps_fixate(caps);
  gst_pad_push_event(pad_, gst_event_new_caps(caps));
  gst_caps_unref(caps);
  negotiated_ = true;
  return true;
}

GstFlowReturn Stream::begin_segment(const GstEvent* event) {
  auto* const given = const_cast<GstEvent*>(event);
  gst_event_copy_segment(given, &segment_);
  if (!negotiate()) return GST_FLOW_NOT_NEGOTIATED;
  const bool has_samples = segment_.format == GST_FORMAT_TIME && segment_.rate > 0;
  const GstSegment segment = has_samples ? running_segment(segment_) : segment_;
  if (has_samples && is_continued(sent_, segment)) return GST_FLOW_OK;
  const int64_t begin_ns = has_samples && is_time(segment.start) ? signed_ns(segment.start) : 0;
  const bool is_near = begin_ns - last_frame_ns_ <= kLongestSilence_ns;
  const GstFlowReturn flow = settle(is_near ? begin_ns : 0);
  sent_ = segment;
  GstEvent* const own = gst_event_new_segment(&segment);
  gst_event_set_seqnum(own, gst_event_get_seqnum(given));
  gst_pad_push_event(pad_, own);
  gst_pad_push_event(pad_, gst_event_new_tag(tags()));
  return flow;
}

/// Returns -1 if the time is not shown.
int64_t Stream::running_ns(guint64 time) const {
  const GstClockTime running = gst_segment_to_running_time(&segment_, GST_FORMAT_TIME, time);
  return is_time(running) ? signed_ns(running) : -1;
}

void Stream::begin_at(int64_t time_ns) {
  sampler_.begin(time_ns);
  begun_ = true;
  discont_ = true;
  jumped_to_ns_ = -1;
  last_frame_ns_ = time_ns;
  interval_ns_ = 0;
}

bool Stream::is_alone(int64_t time_ns) {
  const int64_t before_ns = std::exchange(jumped_to_ns_, time_ns);
  if (before_ns >= 0) return std::llabs(time_ns - before_ns) > kLongestSilence_ns;
  GST_ELEMENT_WARNING(
      GST_PAD_PARENT(pad_), STREAM, FORMAT,
      ("The time stamps of the video jump from %.3f s to %.3f s: the haptic track "
       "has no samples in between.",
       1e-9 * static_cast<double>(last_frame_ns_), 1e-9 * static_cast<double>(time_ns)),
      ("At most an hour without a frame becomes silence."));
  return true;
}

GstFlowReturn Stream::add(const FrameWrench& frame) {
  const bool in_time = segment_.format == GST_FORMAT_TIME && is_time(frame.pts);
  if (!in_time) return GST_FLOW_OK;  // spidarmotion reports why such a frame is not felt
  const bool has_duration = is_time(frame.duration);
  guint64 from = 0, to = 0;
  if (!gst_segment_clip(&segment_, GST_FORMAT_TIME, frame.pts,
                        has_duration ? frame.pts + frame.duration : GST_CLOCK_TIME_NONE, &from,
                        &to)) {
    return GST_FLOW_OK;
  }
  if (segment_.rate < 0) {
    gst_pad_push_event(pad_,
                       gst_event_new_gap(from, has_duration ? to - from : GST_CLOCK_TIME_NONE));
    return GST_FLOW_OK;
  }
  const int64_t time_ns = running_ns(from);
  if (time_ns < 0) return GST_FLOW_OK;
  if (!begun_) begin_at(signed_ns(sent_.start));
  if (time_ns < last_frame_ns_) return GST_FLOW_OK;
  if (time_ns - last_frame_ns_ > kLongestSilence_ns) {
    if (is_alone(time_ns)) return GST_FLOW_OK;
    const GstFlowReturn flow = settle(0);
    if (flow != GST_FLOW_OK) return flow;
    begin_at(time_ns);
  }
  jumped_to_ns_ = -1;
  const int64_t since_ns = time_ns - last_frame_ns_;
  const bool follows = frame.compared || frame.repeats;
  if (frame.known) {
    const int64_t hold_ns = follows ? WrenchTimeline::hold_after(since_ns) : 0;
    sampler_.add({time_ns, hold_ns, frame.wrench, frame.repeats, frame.interval_ns / 2});
  }
  last_wrench_ = frame.wrench;
  const int64_t lasts_ns = has_duration ? running_ns(to) - time_ns : -1;
  interval_ns_ = lasts_ns >= 0 && lasts_ns <= kLongestSilence_ns ? lasts_ns : since_ns;
  last_frame_ns_ = time_ns;
  constexpr auto kAhead_ns = static_cast<int64_t>(kLookAhead_ns);
  return push_until(std::max(sampler_.settled_ns(kAhead_ns), time_ns - kAhead_ns));
}

GstFlowReturn Stream::add_gap(GstClockTime pts) {
  if (!begun_ || segment_.format != GST_FORMAT_TIME || segment_.rate < 0 || !is_time(pts)) {
    return GST_FLOW_OK;
  }
  const int64_t time_ns = running_ns(pts);
  if (time_ns < 0 || time_ns - last_frame_ns_ > kLongestSilence_ns) return GST_FLOW_OK;
  sampler_.add({time_ns, 0, Wrench(), false});
  return push_until(sampler_.settled_ns(static_cast<int64_t>(kLookAhead_ns)));
}

GstFlowReturn Stream::settle(int64_t until_ns) {
  if (!begun_) return GST_FLOW_OK;
  const int64_t end_ns = last_frame_ns_ + interval_ns_;
  sampler_.add({end_ns, 0, Wrench(), false});
  const GstFlowReturn flow = push_until(std::max(end_ns, until_ns));
  return flow == GST_FLOW_OK && filled_ > 0 ? push() : flow;
}

GstFlowReturn Stream::finish() {
  const GstFlowReturn flow = settle(0);
  flush();
  return flow;
}

void Stream::flush() {
  begun_ = pushed_ = false;
  gst_segment_init(&sent_, GST_FORMAT_UNDEFINED);
  if (!buffer_) return;
  gst_buffer_unmap(buffer_, &map_);
  gst_clear_buffer(&buffer_);
  filled_ = 0;
}

void Stream::reset() {
  flush();
  gst_segment_init(&segment_, GST_FORMAT_UNDEFINED);
  negotiated_ = false;
}

GstFlowReturn Stream::push_until(int64_t time_ns) {
  while (sampler_.next_ns() < time_ns) {
    const auto pts = static_cast<GstClockTime>(sampler_.next_ns());
    const GstFlowReturn flow = push(to_track_sample(sampler_.next()), pts);
    if (flow != GST_FLOW_OK) return flow;
  }
  return GST_FLOW_OK;
}

GstFlowReturn Stream::push(const TrackSample& sample, GstClockTime pts) {
  if (!buffer_) {
    buffer_ = gst_buffer_new_allocate(nullptr, kBufferSamples * sizeof(TrackSample), nullptr);
    gst_buffer_map(buffer_, &map_, GST_MAP_WRITE);
    GST_BUFFER_PTS(buffer_) = pts;
    silent_ = true;
  }
  for (size_t i = 0; i < kTrackChannels; ++i) {
    GST_WRITE_FLOAT_LE(map_.data + filled_ * sizeof sample + i * sizeof(float), sample[i]);
    silent_ = silent_ && sample[i] == 0;
  }
  return ++filled_ == kBufferSamples ? push() : GST_FLOW_OK;
}

GstFlowReturn Stream::push() {
  GstBuffer* const full = buffer_;
  gst_buffer_unmap(full, &map_);
  gst_buffer_set_size(full, static_cast<gssize>(filled_ * sizeof(TrackSample)));
  GST_BUFFER_DURATION(full) = filled_ * kTrackPeriod_ns;
  GST_BUFFER_OFFSET(full) = GST_BUFFER_PTS(full) / kTrackPeriod_ns;
  GST_BUFFER_OFFSET_END(full) = GST_BUFFER_OFFSET(full) + filled_;
  if (silent_) GST_BUFFER_FLAG_SET(full, GST_BUFFER_FLAG_GAP);
  if (discont_) GST_BUFFER_FLAG_SET(full, GST_BUFFER_FLAG_DISCONT);
  buffer_ = nullptr;
  filled_ = 0;
  discont_ = false;
  if (!negotiate()) {
    gst_buffer_unref(full);
    return GST_FLOW_NOT_NEGOTIATED;
  }
  pushed_ = true;
  return gst_pad_push(pad_, full);
}

}  // namespace spidar::tracks
