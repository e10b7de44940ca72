// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/filter/reports/message_and_meta.h"

#include <utility>

#include <gst-spidar/gstspidarmotionmeta.h>

#include "core/motion/objects/moving_object.h"
#include "plugin/filter/reports/no_force_watch.h"

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

/// What a frame shows and how it is felt, as message and meta have it.
GstSpidarFrameMotion motion_of(const ImageMotion& felt, const Wrench& wrench) {
  GstSpidarFrameMotion m{};
  m.velocity_x = felt.velocity_px_s.x();
  m.velocity_y = felt.velocity_px_s.y();
  m.growth = felt.growth_1_s;
  m.roll = felt.roll_rad_s;
  m.force_x = wrench.force_N.x();
  m.force_y = wrench.force_N.y();
  m.force_z = wrench.force_N.z();
  m.torque_x = wrench.torque_Nm.x();
  m.torque_y = wrench.torque_Nm.y();
  m.torque_z = wrench.torque_Nm.z();
  return m;
}

void set_motion(GstStructure* structure, const GstSpidarFrameMotion& m) {
  const std::pair<const char*, double> fields[] = {
      {"velocity-x", m.velocity_x}, {"velocity-y", m.velocity_y}, {"force-x", m.force_x},
      {"force-y", m.force_y},       {"force-z", m.force_z},       {"torque-x", m.torque_x},
      {"torque-y", m.torque_y},     {"torque-z", m.torque_z},
  };
  for (const auto& [name, value] : fields) {
    gst_structure_set(structure, name, G_TYPE_DOUBLE, value, nullptr);
  }
}

void set_values(GstStructure* structure, const GstSpidarFrameMotion& m) {
  gst_structure_set(structure, "width", G_TYPE_UINT, m.width, "height", G_TYPE_UINT, m.height,
                    "running-time", G_TYPE_UINT64, m.running_time, "interval", G_TYPE_UINT64,
                    m.interval, "growth", G_TYPE_DOUBLE, m.growth, "roll", G_TYPE_DOUBLE, m.roll,
                    nullptr);
  set_motion(structure, m);
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

/// Of the one object that is felt; 0 if it is none, or not one alone.
double felt_error_px_s(const Frame& frame) {
  for (const MovingObject& object : frame.objects) {
    if (object.id == frame.felt_object) return object.error_px_s;
  }
  return 0;
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

void attach_motion_meta(GstBuffer* buffer, const FrameReport& report, int width, int height) {
  GstCustomMeta* before = gst_buffer_get_custom_meta(buffer, GST_SPIDAR_MOTION_META_NAME);
  if (before) gst_buffer_remove_meta(buffer, reinterpret_cast<GstMeta*>(before));
  GstSpidarFrameMotion motion = motion_of(report.frame.motion, report.frame.wrench);
  motion.width = static_cast<guint>(width);
  motion.height = static_cast<guint>(height);
  motion.running_time = static_cast<guint64>(report.frame.running_ns);
  motion.interval = static_cast<guint64>(report.frame.interval_ns);
  std::vector<GstSpidarMotionTrack> tracks;
  tracks.reserve(report.tracks.size());
  for (const OwnedTrack& track : report.tracks) {
    tracks.push_back(
        {track.id, track.from.x_px, track.from.y_px, track.to.x_px, track.to.y_px, track.object});
  }
  GstStructure* structure = add_meta(buffer);
  set_values(structure, motion);
  gst_structure_set(structure, "repeated", G_TYPE_BOOLEAN, report.frame.goes_on() ? TRUE : FALSE,
                    nullptr);
  set_tracks(structure, tracks);
}

void post_motion_message(GstElement* element, GstBuffer* buffer, const FrameReport& report,
                         gint* unread) {
  if (g_atomic_int_get(unread) >= kMostUnread) return;
  const Frame& frame = report.frame;
  GstStructure* s =
      gst_structure_new("spidar-motion",                                                        //
                        "timestamp", G_TYPE_UINT64, GST_BUFFER_PTS(buffer),                     //
                        "stream-time", G_TYPE_UINT64, static_cast<guint64>(frame.stream_ns),    //
                        "running-time", G_TYPE_UINT64, static_cast<guint64>(frame.running_ns),  //
                        "duration", G_TYPE_UINT64, GST_BUFFER_DURATION(buffer),                 //
                        "repeated", G_TYPE_BOOLEAN, is_again(frame.picture) ? TRUE : FALSE,     //
                        "features", G_TYPE_UINT, static_cast<guint>(frame.features),            //
                        "tracked", G_TYPE_UINT, static_cast<guint>(frame.motion.tracked),       //
                        "object", G_TYPE_UINT, frame.felt_object,                               //
                        "track", G_TYPE_STRING, report.track ? report.track->c_str() : "",      //
                        nullptr);
  set_motion(s, motion_of(frame.motion, frame.wrench));
  gst_structure_set(s, "velocity-error", G_TYPE_DOUBLE, felt_error_px_s(frame), nullptr);
  describe_limits(report.limit, report.device_limit, s);
  GstMessage* const message = gst_message_new_element(GST_OBJECT(element), s);
  g_atomic_int_inc(unread);
  // The message holds the element until then.
  const auto count_down = [](gpointer count, GstMiniObject*) {
    g_atomic_int_add(static_cast<gint*>(count), -1);
  };
  gst_mini_object_weak_ref(GST_MINI_OBJECT_CAST(message), count_down, unread);
  gst_element_post_message(element, message);
}

}  // namespace spidar
