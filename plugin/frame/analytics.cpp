// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/frame/analytics.h"

#include <gst/analytics/analytics.h>

namespace spidar {

std::vector<ObjectBox> read_detections(GstBuffer* buffer) {
  std::vector<ObjectBox> boxes;
  GstAnalyticsRelationMeta* const meta = gst_buffer_get_analytics_relation_meta(buffer);
  if (!meta) return boxes;
  const GQuark ours = g_quark_from_static_string(kObjectName);
  gpointer state = nullptr;
  GstAnalyticsMtd found;
  while (gst_analytics_relation_meta_iterate(meta, &state, gst_analytics_od_mtd_get_mtd_type(),
                                             &found)) {
    const GQuark name = gst_analytics_od_mtd_get_obj_type(&found);
    gint x = 0, y = 0, width = 0, height = 0;
    gfloat confidence = 0;
    if (name == ours ||
        !gst_analytics_od_mtd_get_location(&found, &x, &y, &width, &height, &confidence)) {
      continue;
    }
    const char* const text = g_quark_to_string(name);
    boxes.push_back({text ? text : "", static_cast<double>(x), static_cast<double>(y),
                     static_cast<double>(width), static_cast<double>(height)});
  }
  return boxes;
}

void attach_detection(GstBuffer* buffer, const ObjectBox& box, uint32_t id) {
  GstAnalyticsRelationMeta* meta = gst_buffer_get_analytics_relation_meta(buffer);
  if (!meta) meta = gst_buffer_add_analytics_relation_meta(buffer);
  // When an object was seen first is not known here.
  GstAnalyticsMtd detection, track;
  constexpr gfloat kConfidence = 1;  // it has moved for some frames, or it would not be an object
  if (gst_analytics_relation_meta_add_od_mtd(
          meta, g_quark_from_string(box.name.c_str()), static_cast<gint>(box.x),
          static_cast<gint>(box.y), static_cast<gint>(box.width), static_cast<gint>(box.height),
          kConfidence, &detection) &&
      gst_analytics_relation_meta_add_tracking_mtd(meta, id, GST_CLOCK_TIME_NONE, &track)) {
    gst_analytics_tracking_mtd_update_last_seen(&track, GST_BUFFER_PTS(buffer));
    gst_analytics_relation_meta_set_relation(meta, GST_ANALYTICS_REL_TYPE_RELATE_TO, detection.id,
                                             track.id);
  }
}

}  // namespace spidar
