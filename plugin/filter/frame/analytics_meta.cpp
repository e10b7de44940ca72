// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/filter/frame/analytics_meta.h"

#include <gst/analytics/analytics.h>

namespace spidar {
namespace {

struct TrackInfo {
  guint64 id = 0;
  gboolean lost = FALSE;
};

/// Whoever relates them may begin at either.
bool relate(GstAnalyticsRelationMeta* meta, guint a, guint b) {
  return gst_analytics_relation_meta_get_relation(meta, a, b) != GST_ANALYTICS_REL_TYPE_NONE ||
         gst_analytics_relation_meta_get_relation(meta, b, a) != GST_ANALYTICS_REL_TYPE_NONE;
}

/// The track of a detection; false when there is none.
bool find_track(GstAnalyticsRelationMeta* meta, guint detection, TrackInfo& info) {
  gpointer state = nullptr;
  GstAnalyticsTrackingMtd track;
  while (gst_analytics_relation_meta_iterate(meta, &state,
                                             gst_analytics_tracking_mtd_get_mtd_type(), &track)) {
    GstClockTime first_seen, last_seen;
    if (relate(meta, detection, track.id) &&
        gst_analytics_tracking_mtd_get_info(&track, &info.id, &first_seen, &last_seen,
                                            &info.lost)) {
      return true;
    }
  }
  return false;
}

}  // namespace

const bool kHasAnalytics = true;

void read_analytics_meta(GstBuffer* buffer, std::vector<ObjectBox>& boxes) {
  GstAnalyticsRelationMeta* const meta = gst_buffer_get_analytics_relation_meta(buffer);
  if (!meta) return;
  gpointer state = nullptr;
  GstAnalyticsODMtd detection;
  while (gst_analytics_relation_meta_iterate(meta, &state, gst_analytics_od_mtd_get_mtd_type(),
                                             &detection)) {
    gint x, y, width, height;
    gfloat confidence;
    if (!gst_analytics_od_mtd_get_location(&detection, &x, &y, &width, &height, &confidence)) {
      continue;
    }
    const char* const name = g_quark_to_string(gst_analytics_od_mtd_get_obj_type(&detection));
    TrackInfo track;
    const bool has_track = find_track(meta, detection.id, track);
    if (has_track && track.lost) continue;
    // Trackers may count from 0 on.
    boxes.push_back({name ? name : "", has_track ? track.id + 1 : 0, static_cast<double>(x),
                     static_cast<double>(y), static_cast<double>(width),
                     static_cast<double>(height)});
  }
}

void attach_analytics_meta(GstBuffer* buffer, const std::vector<ObjectBox>& boxes) {
  if (boxes.empty()) return;
  GstAnalyticsRelationMeta* meta = gst_buffer_get_analytics_relation_meta(buffer);
  if (!meta) meta = gst_buffer_add_analytics_relation_meta(buffer);
  for (const ObjectBox& box : boxes) {
    GstAnalyticsODMtd detection;
    GstAnalyticsTrackingMtd track;
    // Nothing tells how sure it is; when it was seen first is not known either.
    constexpr gfloat kSure = 1;
    const bool added =
        gst_analytics_relation_meta_add_od_mtd(meta, g_quark_from_string(box.name.c_str()),
                                               static_cast<gint>(box.x), static_cast<gint>(box.y),
                                               static_cast<gint>(box.width),
                                               static_cast<gint>(box.height), kSure, &detection) &&
        gst_analytics_relation_meta_add_tracking_mtd(meta, box.track, GST_CLOCK_TIME_NONE, &track);
    if (!added) return;
    gst_analytics_tracking_mtd_update_last_seen(&track, GST_BUFFER_PTS(buffer));
    gst_analytics_relation_meta_set_relation(meta, GST_ANALYTICS_REL_TYPE_RELATE_TO, detection.id,
                                             track.id);
  }
}

}  // namespace spidar
