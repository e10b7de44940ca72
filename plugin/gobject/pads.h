// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <gst/gst.h>

namespace spidar {

/// Gives the element the pad that the template describes and returns it. The element keeps it.
inline GstPad* add_pad(GstElement* element, GstStaticPadTemplate* pad_template) {
  GstPad* pad = gst_pad_new_from_static_template(pad_template, pad_template->name_template);
  gst_element_add_pad(element, pad);
  return pad;
}

/// Stream time of a buffer that passes the pad; GST_CLOCK_TIME_NONE when it has none.
inline GstClockTime stream_time_of(GstPad* pad, GstBuffer* buffer) {
  GstEvent* const event = gst_pad_get_sticky_event(pad, GST_EVENT_SEGMENT, 0);
  if (!event) return GST_CLOCK_TIME_NONE;
  const GstSegment* segment = nullptr;
  gst_event_parse_segment(event, &segment);
  const GstClockTime time =
      segment->format == GST_FORMAT_TIME && GST_BUFFER_PTS_IS_VALID(buffer)
          ? gst_segment_to_stream_time(segment, GST_FORMAT_TIME, GST_BUFFER_PTS(buffer))
          : GST_CLOCK_TIME_NONE;
  gst_event_unref(event);
  return time;
}

}  // namespace spidar
