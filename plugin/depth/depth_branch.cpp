// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/depth/depth_branch.h"

#include <string>
#include <utility>

#include "plugin/reports/category.h"

#undef GST_CAT_DEFAULT
#define GST_CAT_DEFAULT spidar::category_of(element_)

namespace spidar {

GstClockTime VideoStream::frame_ns() const {
  const gint n = GST_VIDEO_INFO_FPS_N(&info);
  const gint d = GST_VIDEO_INFO_FPS_D(&info);
  if (n <= 0 || d <= 0) return 0;
  return gst_util_uint64_scale_int(GST_SECOND, d, n);
}

void VideoStream::reset() {
  gst_segment_init(&segment, GST_FORMAT_UNDEFINED);
  gst_video_info_init(&info);
}

GstFlowReturn DepthBranch::add(GstBuffer* buffer) {
  DepthImage image;
  image.buffer.reset(buffer);
  if (!caps_) return GST_FLOW_NOT_NEGOTIATED;
  const auto time = shown_time(stream_.segment, buffer, stream_.frame_ns());
  if (!time) {
    if (!std::exchange(warned_, true)) {
      GST_ELEMENT_WARNING(
          element_, STREAM, FORMAT,
          ("Depth images without timestamps are left out: they belong to no frame."),
          ("A segment in time and timestamps on every buffer are needed; for one still image "
           "put 'imagefreeze' in front of 'depth_sink'."));
    }
    return GST_FLOW_OK;
  }
  image.caps.reset(gst_caps_ref(caps_.get()));
  image.time = *time;
  ++images_;
  return gate_.add(std::move(image));
}

gboolean DepthBranch::set_caps(GstCaps* caps, const DepthProperties& properties) {
  GstVideoInfo info;
  if (!gst_video_info_from_caps(&info, caps)) return FALSE;
  const std::string trouble = properties.trouble(GST_VIDEO_INFO_FORMAT(&info));
  if (!trouble.empty()) {
    GST_ELEMENT_ERROR(element_, LIBRARY, SETTINGS, ("%s", trouble.c_str()), (nullptr));
    return FALSE;
  }
  stream_.info = info;
  caps_.reset(gst_caps_ref(caps));
  return TRUE;
}

void DepthBranch::skip(GstEvent* event) {
  GstBuffer* gap = gst_buffer_new();
  gst_event_parse_gap(event, &GST_BUFFER_PTS(gap), &GST_BUFFER_DURATION(gap));
  const auto time = shown_time(stream_.segment, gap, 0);
  gst_buffer_unref(gap);
  if (time) gate_.reach(time->end_ns);
}

gboolean DepthBranch::take(GstEvent* event, const DepthProperties& properties) {
  switch (GST_EVENT_TYPE(event)) {
    case GST_EVENT_FLUSH_START:
      gate_.flush_depth(true);
      return TRUE;
    case GST_EVENT_FLUSH_STOP:
      gate_.flush_depth(false);
      stream_.segment.format = GST_FORMAT_UNDEFINED;
      return TRUE;
    case GST_EVENT_STREAM_START:
      gate_.begin_depth();
      return TRUE;
    case GST_EVENT_CAPS: {
      GstCaps* caps;
      gst_event_parse_caps(event, &caps);
      return set_caps(caps, properties);
    }
    case GST_EVENT_SEGMENT:
      gst_event_copy_segment(event, &stream_.segment);
      gate_.begin_depth();
      return TRUE;
    case GST_EVENT_GAP:
      skip(event);
      return TRUE;
    case GST_EVENT_EOS:
      gate_.finish_depth();
      return TRUE;
    default:
      return TRUE;
  }
}

void DepthBranch::reset() {
  stream_.reset();
  caps_.reset();
  warned_ = false;
  images_ = 0;
}

}  // namespace spidar
