// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/depth/branch_latency.h"

#include <algorithm>

namespace spidar {

gboolean query_latency(std::initializer_list<GstPad*> sink_pads, GstQuery* query) {
  gboolean live = FALSE;
  GstClockTime min = 0;
  GstClockTime max = GST_CLOCK_TIME_NONE;
  for (GstPad* pad : sink_pads) {
    if (!gst_pad_is_linked(pad)) continue;
    GstQuery* branch = gst_query_new_latency();
    gboolean branch_live = FALSE;
    GstClockTime branch_min = 0;
    GstClockTime branch_max = GST_CLOCK_TIME_NONE;
    const gboolean known = gst_pad_peer_query(pad, branch);
    if (known) gst_query_parse_latency(branch, &branch_live, &branch_min, &branch_max);
    gst_query_unref(branch);
    if (!known) return FALSE;
    if (!branch_live) continue;
    live = TRUE;
    min = std::max(min, branch_min);
    max = std::min(max, branch_max);  // GST_CLOCK_TIME_NONE is the largest number
  }
  gst_query_set_latency(query, live, min, max);
  return TRUE;
}

}  // namespace spidar
