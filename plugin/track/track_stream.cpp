// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/track/track_stream.h"

#include <algorithm>

#include "plugin/timing/instant_rate.h"

namespace spidar {
namespace {

constexpr size_t kBufferSamples = TrackStream::kBuffer_ns / kTrackPeriod_ns;
/// If the first frame is further than this from the beginning of its segment, the track begins with
/// that frame and not with silence: the timestamps are those of a source that has been running for
/// long.
constexpr int64_t kLongestSilentStart_ns = 10'000'000'000;

GstTagList* describe_track() {
  GstTagList* tags =
      gst_tag_list_new(GST_TAG_TITLE, "Haptic track", GST_TAG_COMMENT,
                       "Wrench on the grip: fx fy fz tx ty tz; x right, y up, z towards the "
                       "viewer. Full scale is 10 "
                       "N and 1 N m.",
                       GST_TAG_EXTENDED_COMMENT, "HAPTIC_FULL_SCALE=10 N, 1 N m", nullptr);
  gst_tag_list_set_scope(tags, GST_TAG_SCOPE_STREAM);
  return tags;
}

bool is_continued(const GstSegment& a, const GstSegment& b) {
  return a.format == b.format && a.rate == b.rate && a.start == b.start && a.base == b.base &&
         a.time == b.time && a.offset == b.offset;
}

int64_t signed_ns(GstClockTime time) {
  return static_cast<int64_t>(time);
}

}  // namespace

TrackStream::TrackStream(GstPad* pad) : pad_(pad) {
  gst_segment_init(&segment_, GST_FORMAT_UNDEFINED);
}

TrackStream::~TrackStream() {
  flush();
}

void TrackStream::begin_stream(GstElement* element, const GstEvent* stream_start) {
  // gst_event_parse_*() take non-const events, but do not change them.
  auto* const given = const_cast<GstEvent*>(stream_start);
  gchar* const id = gst_pad_create_stream_id(pad_, element, "wrench");
  GstEvent* const event = gst_event_new_stream_start(id);
  g_free(id);
  guint group;
  if (gst_event_parse_group_id(given, &group)) gst_event_set_group_id(event, group);
  gst_event_set_seqnum(event, gst_event_get_seqnum(given));
  gst_pad_push_event(pad_, event);
  negotiated_ = false;
}

bool TrackStream::negotiate() {
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

GstFlowReturn TrackStream::begin_segment(const GstEvent* event) {
  auto* const given = const_cast<GstEvent*>(event);
  const GstSegment* segment;
  gst_event_parse_segment(given, &segment);
  const bool continued = is_continued(segment_, *segment);
  const GstFlowReturn flow = continued ? GST_FLOW_OK : finish();
  segment_ = *segment;
  if (!negotiate()) return GST_FLOW_NOT_NEGOTIATED;
  gst_pad_push_event(pad_, gst_event_ref(given));
  if (!continued) gst_pad_push_event(pad_, gst_event_new_tag(describe_track()));
  return flow;
}

void TrackStream::begin_at(int64_t first_frame_ns) {
  const auto start_ns = signed_ns(std::min(segment_.start, GstClockTime{kLatest_ns}));
  const bool silent_start = first_frame_ns - start_ns <= kLongestSilentStart_ns;
  sampler_.begin(silent_start ? start_ns : first_frame_ns);
  begun_ = true;
  discont_ = true;
  last_frame_ns_ = first_frame_ns;
  interval_ns_ = 0;
}

GstFlowReturn TrackStream::add(const FrameWrench& frame) {
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
  const int64_t time_ns = signed_ns(from);
  if (!begun_) begin_at(time_ns);
  if (time_ns < last_frame_ns_) return GST_FLOW_OK;
  const int64_t since_ns = time_ns - last_frame_ns_;
  const bool follows = frame.compared || frame.repeats;
  if (frame.known) {
    const int64_t hold_ns = follows ? WrenchTimeline::hold_after(since_ns) : 0;
    sampler_.add({time_ns, hold_ns, frame.wrench, frame.repeats});
  }
  last_wrench_ = frame.wrench;
  interval_ns_ = has_duration ? signed_ns(to - from) : since_ns;
  last_frame_ns_ = time_ns;
  constexpr auto kAhead_ns = static_cast<int64_t>(kLookAhead_ns);
  return put_until(std::max(sampler_.settled_ns(kAhead_ns), time_ns - kAhead_ns));
}

GstFlowReturn TrackStream::add_gap(GstClockTime pts) {
  if (!begun_ || segment_.rate < 0 || !is_time(pts)) return GST_FLOW_OK;
  sampler_.add({signed_ns(pts), 0, Wrench(), false});
  return put_until(sampler_.settled_ns(static_cast<int64_t>(kLookAhead_ns)));
}

GstFlowReturn TrackStream::finish() {
  if (!begun_) return GST_FLOW_OK;
  const int64_t end_ns = last_frame_ns_ + interval_ns_;
  sampler_.add({end_ns, 0, Wrench(), false});
  GstFlowReturn flow = put_until(end_ns);
  if (flow == GST_FLOW_OK && filled_ > 0) flow = push();
  flush();
  return flow;
}

void TrackStream::flush() {
  begun_ = false;
  if (!buffer_) return;
  gst_buffer_unmap(buffer_, &map_);
  gst_clear_buffer(&buffer_);
  filled_ = 0;
}

void TrackStream::reset() {
  flush();
  gst_segment_init(&segment_, GST_FORMAT_UNDEFINED);
  negotiated_ = false;
}

GstFlowReturn TrackStream::put_until(int64_t time_ns) {
  while (sampler_.next_ns() < time_ns) {
    const auto pts = static_cast<GstClockTime>(sampler_.next_ns());
    const GstFlowReturn flow = put(to_track_sample(sampler_.take()), pts);
    if (flow != GST_FLOW_OK) return flow;
  }
  return GST_FLOW_OK;
}

GstFlowReturn TrackStream::put(const TrackSample& sample, GstClockTime pts) {
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

GstFlowReturn TrackStream::push() {
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
  return gst_pad_push(pad_, full);
}

}  // namespace spidar
