// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// How a sink waits for a moment of playback.
#pragma once

#include <gst/base/gstbasesink.h>

namespace spidar {

/// Waits until `ahead_ns` before this running time. `object` is used for preroll when the sink is
/// paused meanwhile.
inline GstFlowReturn wait_until(GstBaseSink* sink, GstMiniObject* object, gint64 running_ns,
                                gint64 ahead_ns) {
  GstClockReturn waited;
  do {
    const GstFlowReturn flow = gst_base_sink_do_preroll(sink, object);
    if (flow != GST_FLOW_OK) return flow;
    const gint64 due_ns = running_ns + static_cast<gint64>(gst_base_sink_get_latency(sink)) +
                          gst_base_sink_get_ts_offset(sink) - ahead_ns;
    waited = gst_base_sink_wait_clock(sink, static_cast<GstClockTime>(MAX(due_ns, 0)), nullptr);
    if (sink->flushing) return GST_FLOW_FLUSHING;
  } while (waited == GST_CLOCK_UNSCHEDULED);
  return GST_FLOW_OK;
}

}  // namespace spidar
