// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/filter/frame/object_metas.h"

#include <algorithm>

namespace spidar {
namespace {

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

/// In whole pixels of the frame.
struct Box {
  guint x, y, width, height;
};

/// The whole pixels of the frame that it touches; an object may reach over the edge.
Box box_of(const MovingObject& object, const VisiblePart& part, int width, int height) {
  const Eigen::Vector2d middle_px =
      Eigen::Vector2d(part.x + 0.5 * part.width, part.y + 0.5 * part.height) + object.position_px;
  const Eigen::Array2d size_px(width, height);
  const Eigen::Array2d from_px =
      (middle_px - object.size_px / 2).array().floor().max(0.0).min(size_px);
  const Eigen::Array2d to_px =
      (middle_px + object.size_px / 2).array().ceil().max(0.0).min(size_px);
  const auto whole = [](double px) { return static_cast<guint>(std::max(px, 0.0)); };
  return {whole(from_px.x()), whole(from_px.y()), whole(to_px.x() - from_px.x()),
          whole(to_px.y() - from_px.y())};
}

GstStructure* motion_of_object(const MovingObject& object, bool felt, int width, int height) {
  return gst_structure_new(
      "spidar-motion", "width", G_TYPE_UINT, static_cast<guint>(width), "height", G_TYPE_UINT,
      static_cast<guint>(height), "velocity-x", G_TYPE_DOUBLE, object.relative_px_s.x(),
      "velocity-y", G_TYPE_DOUBLE, object.relative_px_s.y(), "screen-velocity-x", G_TYPE_DOUBLE,
      object.on_screen_px_s.x(), "screen-velocity-y", G_TYPE_DOUBLE, object.on_screen_px_s.y(),
      "velocity-error", G_TYPE_DOUBLE, object.error_px_s, "growth", G_TYPE_DOUBLE,
      object.growth_1_s, "roll", G_TYPE_DOUBLE, object.roll_rad_s, "felt", G_TYPE_BOOLEAN,
      felt ? TRUE : FALSE, nullptr);
}

}  // namespace

void attach_object_metas(GstBuffer* buffer, const FrameReport& report, int width, int height) {
  remove_ours(buffer);
  for (const MovingObject& object : report.frame.objects) {
    if (object.tracks == 0) continue;
    const Box box = box_of(object, report.visible, width, height);
    if (box.width == 0 || box.height == 0) continue;
    GstVideoRegionOfInterestMeta* const region = gst_buffer_add_video_region_of_interest_meta(
        buffer, kObjectName, box.x, box.y, box.width, box.height);
    region->id = static_cast<gint>(object.id);
    gst_video_region_of_interest_meta_add_param(
        region, motion_of_object(object, object.id == report.frame.felt_object, width, height));
  }
}

}  // namespace spidar
