// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tools/stream_time.h"

#include <algorithm>

namespace spidar {
namespace {

GstPadProbeReturn move_segment(GstPad*, GstPadProbeInfo* info, gpointer) {
  GstEvent* const event = GST_PAD_PROBE_INFO_EVENT(info);
  if (GST_EVENT_TYPE(event) != GST_EVENT_SEGMENT) return GST_PAD_PROBE_OK;
  GstSegment segment;
  gst_event_copy_segment(event, &segment);
  if (segment.format != GST_FORMAT_TIME || segment.time <= segment.base) return GST_PAD_PROBE_OK;
  // As much as possible by an earlier beginning, so that the track begins with the film.
  const GstClockTime earlier = std::min(segment.start, segment.time - segment.base);
  segment.start -= earlier;
  segment.time -= earlier;
  segment.base = segment.time;
  GstEvent* const moved = gst_event_new_segment(&segment);
  gst_event_set_seqnum(moved, gst_event_get_seqnum(event));
  gst_event_unref(event);
  GST_PAD_PROBE_INFO_DATA(info) = moved;
  return GST_PAD_PROBE_OK;
}

}  // namespace

void follow_stream_time(GstPad* pad) {
  gst_pad_add_probe(pad, GST_PAD_PROBE_TYPE_EVENT_DOWNSTREAM, move_segment, nullptr, nullptr);
}

}  // namespace spidar
