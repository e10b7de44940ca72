// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/depth/depth_meta.h"

#include <gst-spidar/gstspidardepthmeta.h>
#include <gst/video/video.h>

namespace spidar {
namespace {

/// The depth image covers the whole picture, so it remains valid when the frame is copied,
/// converted or scaled, but not when it is cropped or rotated.
gboolean transform(GstBuffer* to, GstCustomMeta* meta, GstBuffer*, GQuark type, gpointer data,
                   gpointer) {
  const bool copied =
      GST_META_TRANSFORM_IS_COPY(type) && !static_cast<const GstMetaTransformCopy*>(data)->region;
  if (!copied && !GST_VIDEO_META_TRANSFORM_IS_SCALE(type)) return FALSE;
  GstCustomMeta* copy = gst_buffer_add_custom_meta(to, GST_SPIDAR_DEPTH_META_NAME);
  gst_structure_foreach(
      gst_custom_meta_get_structure(meta),
      [](GQuark field, const GValue* value, gpointer target) -> gboolean {
        gst_structure_id_set_value(static_cast<GstStructure*>(target), field, value);
        return TRUE;
      },
      gst_custom_meta_get_structure(copy));
  return TRUE;
}

}  // namespace

void register_depth_meta() {
  static const bool registered = [] {
    // Elements that change one of these call transform() or drop the meta.
    const gchar* tags[] = {GST_META_TAG_VIDEO_STR, GST_META_TAG_VIDEO_SIZE_STR,
                           GST_META_TAG_VIDEO_ORIENTATION_STR, nullptr};
    return gst_meta_register_custom(GST_SPIDAR_DEPTH_META_NAME, tags, transform, nullptr,
                                    nullptr) != nullptr;
  }();
  (void)registered;
}

void attach_depth_meta(GstBuffer* frame, GstBuffer* depth, GstCaps* caps, gint64 running_time_ns,
                       const DepthMeaning& meaning) {
  GstCustomMeta* before = gst_buffer_get_custom_meta(frame, GST_SPIDAR_DEPTH_META_NAME);
  if (before) gst_buffer_remove_meta(frame, reinterpret_cast<GstMeta*>(before));
  GstCustomMeta* meta = gst_buffer_add_custom_meta(frame, GST_SPIDAR_DEPTH_META_NAME);
  gst_structure_set(gst_custom_meta_get_structure(meta), "depth", GST_TYPE_BUFFER, depth, "caps",
                    GST_TYPE_CAPS, caps, "running-time", G_TYPE_INT64, running_time_ns, "disparity",
                    G_TYPE_BOOLEAN, meaning.disparity ? TRUE : FALSE, "near", G_TYPE_DOUBLE,
                    meaning.near_sample, "far", G_TYPE_DOUBLE, meaning.far_sample, nullptr);
}

}  // namespace spidar
