// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/frame/object_metas.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include <gst-spidar/gstspidarobjectmeta.h>
#ifdef SPIDAR_HAS_ANALYTICS
#include <gst/analytics/analytics.h>
#endif

#include "plugin/frame/frame_luma.h"

namespace spidar {
namespace {

static_assert(std::string_view(kObjectName) == GST_SPIDAR_OBJECT_TYPE);

const char* text_of(GQuark quark) {
  const char* const text = g_quark_to_string(quark);
  return text ? text : "";
}

void remove_ours(GstBuffer* buffer) {
  const auto remove = [](GstBuffer*, GstMeta** meta, gpointer ours) -> gboolean {
    if ((*meta)->info->api != GST_VIDEO_REGION_OF_INTEREST_META_API_TYPE) return TRUE;
    const auto* const region = reinterpret_cast<GstVideoRegionOfInterestMeta*>(*meta);
    if (region->roi_type == GPOINTER_TO_UINT(ours)) *meta = nullptr;
    return TRUE;
  };
  gst_buffer_foreach_meta(buffer, remove,
                          GUINT_TO_POINTER(g_quark_from_static_string(kObjectName)));
}

/// The box of the object in whole pixels, without the parts outside the frame.
ObjectBox box_of(const MovingObject& object, const PicturePart& part, int width, int height) {
  const Eigen::Vector2d middle_px =
      Eigen::Vector2d(part.x + 0.5 * part.width, part.y + 0.5 * part.height);
  const Eigen::Array2d size_px(width, height);
  const Eigen::Array2d from_px =
      (middle_px + object.drawn_low_px()).array().floor().max(0.0).min(size_px);
  const Eigen::Array2d to_px =
      (middle_px + object.drawn_high_px()).array().ceil().max(0.0).min(size_px);
  return {kObjectName, from_px.x(), from_px.y(), (to_px - from_px).x(), (to_px - from_px).y()};
}

GstStructure* motion_of_object(const MovingObject& object, bool felt, int width, int height) {
  return gst_structure_new(
      GST_SPIDAR_OBJECT_PARAM, "width", G_TYPE_UINT, static_cast<guint>(width), "height",
      G_TYPE_UINT, static_cast<guint>(height), "velocity-x", G_TYPE_DOUBLE,
      object.relative_px_s.x(), "velocity-y", G_TYPE_DOUBLE, object.relative_px_s.y(),
      "screen-velocity-x", G_TYPE_DOUBLE, object.on_screen_px_s.x(), "screen-velocity-y",
      G_TYPE_DOUBLE, object.on_screen_px_s.y(), "velocity-error", G_TYPE_DOUBLE, object.error_px_s,
      "growth", G_TYPE_DOUBLE, object.growth_1_s, "roll", G_TYPE_DOUBLE, object.roll_rad_s, "felt",
      G_TYPE_BOOLEAN, felt ? TRUE : FALSE, nullptr);
}

#ifdef SPIDAR_HAS_ANALYTICS

/// Reads the detections (GstAnalyticsODMtd) that other elements have attached. Leaves out those of
/// spidarmotion, which attaches the same objects as regions, too.
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

/// Attaches a box to `buffer`, which is writable, as a detection with a relation to a
/// GstAnalyticsTrackingMtd of the number `id`. An attached detection cannot be removed again.
void attach_detection(GstBuffer* buffer, const ObjectBox& box, uint32_t id) {
  GstAnalyticsRelationMeta* meta = gst_buffer_get_analytics_relation_meta(buffer);
  if (!meta) meta = gst_buffer_add_analytics_relation_meta(buffer);
  GstAnalyticsMtd detection, track;
  constexpr gfloat kConfidence = 1;  // objects are found after moving for some frames
  // When the object was first seen (GST_CLOCK_TIME_NONE) is not known here.
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

#else

// Without GStreamer 1.24 or newer, frames have no detections.
std::vector<ObjectBox> read_detections(GstBuffer*) {
  return {};
}

void attach_detection(GstBuffer*, const ObjectBox&, uint32_t) {}

#endif

}  // namespace

std::vector<ObjectBox> read_object_metas(GstBuffer* buffer) {
  std::vector<ObjectBox> boxes = read_detections(buffer);
  gpointer state = nullptr;
  while (GstMeta* const meta = gst_buffer_iterate_meta_filtered(
             buffer, &state, GST_VIDEO_REGION_OF_INTEREST_META_API_TYPE)) {
    const auto& region = *reinterpret_cast<GstVideoRegionOfInterestMeta*>(meta);
    // Trackers store corners left of the picture or above it as negative numbers.
    boxes.push_back({text_of(region.roi_type), static_cast<double>(static_cast<gint>(region.x)),
                     static_cast<double>(static_cast<gint>(region.y)),
                     static_cast<double>(region.w), static_cast<double>(region.h)});
  }
  boxes.erase(
      std::remove_if(boxes.begin(), boxes.end(),
                     [](const ObjectBox& box) { return box.width <= 0 || box.height <= 0; }),
      boxes.end());
  return boxes;
}

void attach_object_metas(GstBuffer* buffer, const DrawnFrame& report, int width, int height) {
  remove_ours(buffer);
  for (const MovingObject& object : report.frame.objects) {
    if (object.points == 0) continue;
    const ObjectBox box = box_of(object, report.film_part(), width, height);
    if (box.width <= 0 || box.height <= 0) continue;
    GstVideoRegionOfInterestMeta* const region = gst_buffer_add_video_region_of_interest_meta(
        buffer, kObjectName, static_cast<guint>(box.x), static_cast<guint>(box.y),
        static_cast<guint>(box.width), static_cast<guint>(box.height));
    region->id = static_cast<gint>(object.id);
    gst_video_region_of_interest_meta_add_param(
        region, motion_of_object(object, object.id == report.frame.felt_object, width, height));
    attach_detection(buffer, box, object.id);
  }
}

std::shared_ptr<const std::vector<PictureBox>> boxes_of(const GstVideoFrame& frame,
                                                        std::optional<touch::DepthLayout> packed,
                                                        const Orientation& turn) {
  std::vector<ObjectBox> found = read_object_metas(frame.buffer);
  PicturePart part = visible_part(frame);
  if (packed) (*packed == touch::DepthLayout::kRight ? part.width : part.height) /= 2;
  if (found.empty() || part.width <= 0 || part.height <= 0) return nullptr;
  const auto position = [&](double x_px, double y_px) {
    return turn.displayed_position({(x_px - part.x) / part.width, (y_px - part.y) / part.height});
  };
  auto boxes = std::make_shared<std::vector<PictureBox>>();
  for (ObjectBox& box : found) {
    const Eigen::Vector2d a = position(box.x, box.y);
    const Eigen::Vector2d b = position(box.x + box.width, box.y + box.height);
    boxes->push_back({std::move(box.name), a.cwiseMin(b), a.cwiseMax(b)});
  }
  return boxes;
}

}  // namespace spidar
