/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Copyright 2026 the gst-spidar authors */
/* What spidarmotion with attach-meta=true says of a frame: how to read it in C. The plugin need not
 * be linked. docs/meta.md has the fields, and how other languages read them. */
#ifndef GST_SPIDAR_MOTION_META_H
#define GST_SPIDAR_MOTION_META_H

#include <string.h>

#include <gst/gst.h>

G_BEGIN_DECLS

/* Name of the custom meta (gst_buffer_get_custom_meta()) and of its structure. */
#define GST_SPIDAR_MOTION_META_NAME "GstSpidarMotionMeta"
/* Field "tracks": array of (id, from x, from y, to x, to y, object). */
#define GST_SPIDAR_MOTION_TRACKS_TYPE "a(uddddu)"

/* One point in the frame before and in this one; pixels of this frame, x right, y down, the centre
 * of the first pixel is (0, 0). */
typedef struct {
  guint id; /* the same for as long as the point is followed */
  gdouble from_x, from_y;
  gdouble to_x, to_y;
  guint object; /* 0: none */
} GstSpidarMotionTrack;

typedef struct {
  guint width, height;                  /* of the frame that lengths are pixels of */
  guint64 running_time;                 /* ns */
  guint64 interval;                     /* ns since the frame before; 0: nothing to compare with */
  gdouble velocity_x, velocity_y;       /* of the motion that is felt, px/s */
  gdouble growth;                       /* 1/s */
  gdouble roll;                         /* rad/s, clockwise as seen */
  gdouble force_x, force_y, force_z;    /* wanted, N: x right, y up, z towards the viewer */
  gdouble torque_x, torque_y, torque_z; /* N m */
} GstSpidarMotion;

/* FALSE when the buffer has no such meta: not analysed, or nothing set attach-meta. */
static inline gboolean gst_buffer_get_spidar_motion(GstBuffer* buffer, GstSpidarMotion* motion) {
  GstCustomMeta* meta = gst_buffer_get_custom_meta(buffer, GST_SPIDAR_MOTION_META_NAME);
  memset(motion, 0, sizeof *motion);
  if (meta == NULL) return FALSE;
  return gst_structure_get(
      gst_custom_meta_get_structure(meta), "width", G_TYPE_UINT, &motion->width, "height",
      G_TYPE_UINT, &motion->height, "running-time", G_TYPE_UINT64, &motion->running_time,
      "interval", G_TYPE_UINT64, &motion->interval, "velocity-x", G_TYPE_DOUBLE,
      &motion->velocity_x, "velocity-y", G_TYPE_DOUBLE, &motion->velocity_y, "growth",
      G_TYPE_DOUBLE, &motion->growth, "roll", G_TYPE_DOUBLE, &motion->roll, "force-x",
      G_TYPE_DOUBLE, &motion->force_x, "force-y", G_TYPE_DOUBLE, &motion->force_y, "force-z",
      G_TYPE_DOUBLE, &motion->force_z, "torque-x", G_TYPE_DOUBLE, &motion->torque_x, "torque-y",
      G_TYPE_DOUBLE, &motion->torque_y, "torque-z", G_TYPE_DOUBLE, &motion->torque_z, NULL);
}

/* Whether the frame shows the picture before again, so that the wrench of that one holds on. */
static inline gboolean gst_buffer_repeats_spidar_motion(GstBuffer* buffer) {
  GstCustomMeta* meta = gst_buffer_get_custom_meta(buffer, GST_SPIDAR_MOTION_META_NAME);
  gboolean repeated = FALSE;
  return meta != NULL &&
         gst_structure_get_boolean(gst_custom_meta_get_structure(meta), "repeated", &repeated) &&
         repeated;
}

/* The tracks of a frame as GstSpidarMotionTrack; NULL without the meta, else to be freed with
 * g_array_unref(). */
static inline GArray* gst_buffer_get_spidar_tracks(GstBuffer* buffer) {
  GstCustomMeta* meta = gst_buffer_get_custom_meta(buffer, GST_SPIDAR_MOTION_META_NAME);
  GVariant* tracks = NULL;
  GVariantIter iter;
  GstSpidarMotionTrack track;
  GArray* result;
  if (meta == NULL || !gst_structure_get(gst_custom_meta_get_structure(meta), "tracks",
                                         G_TYPE_VARIANT, &tracks, NULL))
    return NULL;
  result = g_array_new(FALSE, FALSE, sizeof(GstSpidarMotionTrack));
  g_variant_iter_init(&iter, tracks);
  while (g_variant_iter_next(&iter, "(uddddu)", &track.id, &track.from_x, &track.from_y,
                             &track.to_x, &track.to_y, &track.object))
    g_array_append_val(result, track);
  g_variant_unref(tracks);
  return result;
}

G_END_DECLS

#endif
