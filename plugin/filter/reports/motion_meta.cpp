// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/filter/reports/motion_meta.h"

#include <gst-spidar/gstspidarmotionmeta.h>

namespace spidar {
namespace {

GstStructure* add_meta(GstBuffer* buffer) {
  GstCustomMeta* meta = gst_buffer_add_custom_meta(buffer, GST_SPIDAR_MOTION_META_NAME);
  return gst_custom_meta_get_structure(meta);
}

/// A track as GVariant serialises "(uddddu)": doubles at multiples of eight bytes, and zeros where
/// nothing is.
struct SerialisedTrack {
  guint32 id, zero_after_id;
  gdouble from_x, from_y, to_x, to_y;
  guint32 object, zero_after_object;
};
static_assert(sizeof(SerialisedTrack) == 48);

void set_tracks(GstStructure* structure, const std::vector<GstSpidarMotionTrack>& tracks) {
  std::vector<SerialisedTrack> serialised;
  serialised.reserve(tracks.size());
  for (const GstSpidarMotionTrack& t : tracks) {
    serialised.push_back({t.id, 0, t.from_x, t.from_y, t.to_x, t.to_y, t.object, 0});
  }
  // In one piece: a GVariant of each number takes longer than finding the motion does.
  GVariant* array = g_variant_new_fixed_array(
      g_variant_type_element(G_VARIANT_TYPE(GST_SPIDAR_MOTION_TRACKS_TYPE)), serialised.data(),
      serialised.size(), sizeof(SerialisedTrack));
  gst_structure_set(structure, "tracks", G_TYPE_VARIANT, array, nullptr);
}

void set_values(GstStructure* structure, const GstSpidarFrameMotion& m) {
  gst_structure_set(structure, "width", G_TYPE_UINT, m.width, "height", G_TYPE_UINT, m.height,
                    "running-time", G_TYPE_UINT64, m.running_time, "interval", G_TYPE_UINT64,
                    m.interval, "velocity-x", G_TYPE_DOUBLE, m.velocity_x, "velocity-y",
                    G_TYPE_DOUBLE, m.velocity_y, "growth", G_TYPE_DOUBLE, m.growth, "roll",
                    G_TYPE_DOUBLE, m.roll, "force-x", G_TYPE_DOUBLE, m.force_x, "force-y",
                    G_TYPE_DOUBLE, m.force_y, "force-z", G_TYPE_DOUBLE, m.force_z, "torque-x",
                    G_TYPE_DOUBLE, m.torque_x, "torque-y", G_TYPE_DOUBLE, m.torque_y, "torque-z",
                    G_TYPE_DOUBLE, m.torque_z, nullptr);
}

/// Copies the meta of `from` to `to`, whose picture is `scale_x` × `scale_y` times as large.
bool copy_scaled(GstBuffer* to, GstBuffer* from, double scale_x, double scale_y, guint width,
                 guint height) {
  GstSpidarFrameMotion motion;
  GArray* tracks = gst_buffer_get_spidar_tracks(from);
  if (!tracks || !gst_buffer_get_spidar_motion(from, &motion)) {
    g_clear_pointer(&tracks, g_array_unref);
    return false;
  }
  motion.width = width;
  motion.height = height;
  motion.velocity_x *= scale_x;
  motion.velocity_y *= scale_y;
  std::vector<GstSpidarMotionTrack> scaled;
  for (guint i = 0; i < tracks->len; ++i) {
    GstSpidarMotionTrack track = g_array_index(tracks, GstSpidarMotionTrack, i);
    // The corner of the picture, at (−½, −½), stays in place.
    for (gdouble* x : {&track.from_x, &track.to_x}) *x = (*x + 0.5) * scale_x - 0.5;
    for (gdouble* y : {&track.from_y, &track.to_y}) *y = (*y + 0.5) * scale_y - 0.5;
    scaled.push_back(track);
  }
  g_array_unref(tracks);
  GstStructure* structure = add_meta(to);
  set_values(structure, motion);
  gst_structure_set(structure, "repeated", G_TYPE_BOOLEAN, gst_buffer_repeats_spidar_motion(from),
                    nullptr);
  set_tracks(structure, scaled);
  return true;
}

gboolean transform(GstBuffer* to, GstCustomMeta* meta, GstBuffer* from, GQuark type, gpointer data,
                   gpointer) {
  GstStructure* given = gst_custom_meta_get_structure(meta);
  if (GST_META_TRANSFORM_IS_COPY(type)) {
    const auto* copy = static_cast<const GstMetaTransformCopy*>(data);
    if (copy->region) return FALSE;  // the picture is incomplete in a part of the buffer
    gst_structure_foreach(
        given,
        [](GQuark field, const GValue* value, gpointer target) -> gboolean {
          gst_structure_id_set_value(static_cast<GstStructure*>(target), field, value);
          return TRUE;
        },
        add_meta(to));
    return TRUE;
  }
  if (GST_VIDEO_META_TRANSFORM_IS_SCALE(type)) {
    const auto* scale = static_cast<const GstVideoMetaTransform*>(data);
    const GstVideoInfo &in = *scale->in_info, &out = *scale->out_info;
    return copy_scaled(
        to, from, static_cast<double>(GST_VIDEO_INFO_WIDTH(&out)) / GST_VIDEO_INFO_WIDTH(&in),
        static_cast<double>(GST_VIDEO_INFO_HEIGHT(&out)) / GST_VIDEO_INFO_HEIGHT(&in),
        static_cast<guint>(GST_VIDEO_INFO_WIDTH(&out)),
        static_cast<guint>(GST_VIDEO_INFO_HEIGHT(&out)));
  }
  return FALSE;
}

}  // namespace

void register_motion_meta() {
  static const bool registered = [] {
    // The values depend on these: an element that changes one of them calls transform() or drops
    // the meta.
    const gchar* tags[] = {GST_META_TAG_VIDEO_STR, GST_META_TAG_VIDEO_SIZE_STR,
                           GST_META_TAG_VIDEO_ORIENTATION_STR, nullptr};
    return gst_meta_register_custom(GST_SPIDAR_MOTION_META_NAME, tags, transform, nullptr,
                                    nullptr) != nullptr;
  }();
  (void)registered;
}

void attach_motion_meta(GstBuffer* buffer, const FrameReport& report, const SceneView& scene,
                        int width, int height) {
  GstCustomMeta* before = gst_buffer_get_custom_meta(buffer, GST_SPIDAR_MOTION_META_NAME);
  if (before) gst_buffer_remove_meta(buffer, reinterpret_cast<GstMeta*>(before));
  const ImageMotion& felt = scene.motion;
  const Eigen::Vector3d &force = scene.wrench.force_N, &torque = scene.wrench.torque_Nm;
  GstSpidarFrameMotion motion{};
  motion.width = static_cast<guint>(width);
  motion.height = static_cast<guint>(height);
  motion.running_time = static_cast<guint64>(report.frame.running_ns);
  motion.interval = static_cast<guint64>(report.frame.interval_ns);
  motion.velocity_x = felt.velocity_px_s.x();
  motion.velocity_y = felt.velocity_px_s.y();
  motion.growth = felt.growth_1_s;
  motion.roll = felt.roll_rad_s;
  motion.force_x = force.x();
  motion.force_y = force.y();
  motion.force_z = force.z();
  motion.torque_x = torque.x();
  motion.torque_y = torque.y();
  motion.torque_z = torque.z();
  std::vector<GstSpidarMotionTrack> tracks;
  tracks.reserve(scene.tracks.size());
  for (const SceneTrack& track : scene.tracks) {
    tracks.push_back(
        {track.id, track.from.x_px, track.from.y_px, track.to.x_px, track.to.y_px, track.object});
  }
  GstStructure* structure = add_meta(buffer);
  set_values(structure, motion);
  gst_structure_set(structure, "repeated", G_TYPE_BOOLEAN, report.frame.goes_on() ? TRUE : FALSE,
                    nullptr);
  set_tracks(structure, tracks);
}

}  // namespace spidar
