/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Copyright 2026 the gst-spidar authors */
/*! \file
 * Reads in C the data that spidarmotion with attach-meta=true attaches to a frame. A program has to
 * link GStreamer, not the plugin. docs/meta.md lists the fields and shows how other languages read
 * them. */
/* Comments for Doxygen begin with an exclamation mark, because the tools of GObject introspection
 * take two asterisks for comments of their own. */
#ifndef GST_SPIDAR_MOTION_META_H
#define GST_SPIDAR_MOTION_META_H

#include <string.h>

#include <gst/gst.h>

G_BEGIN_DECLS

/*! Name of the custom meta (gst_buffer_get_custom_meta()) and of its structure. */
#define GST_SPIDAR_MOTION_META_NAME "GstSpidarMotionMeta"
/*! Type of the field "points": array of (id, from x, from y, to x, to y, object), the members of
 * GstSpidarMotionPoint. */
#define GST_SPIDAR_MOTION_POINTS_TYPE "a(uddddu)"

/*! One point in the previous frame and in this one. Positions are in pixels of this frame, x right,
 * y down; (0, 0) is the centre of the first pixel. */
typedef struct {
  guint id;       /*!< Stays the same as long as the point is followed. */
  gdouble from_x; /*!< Position in the previous frame, x, px. */
  gdouble from_y; /*!< Position in the previous frame, y, px. */
  gdouble to_x;   /*!< Position in this frame, x, px. */
  gdouble to_y;   /*!< Position in this frame, y, px. */
  guint object;   /*!< Id of the object that the point belongs to; 0: none. */
} GstSpidarMotionPoint;

/*! Motion of one frame, and the wrench that the controller computed from it, before any safety
 * limit. Directions of the wrench are those of the device: x right, y up, z towards the viewer. */
typedef struct {
  guint width;          /*!< Width of the frame that lengths in pixels refer to, px. */
  guint height;         /*!< Height of that frame, px. */
  guint64 running_time; /*!< Running time at which the frame is shown, ns. */
  guint64 interval;     /*!< Time since the frame that it was compared with, ns; 0: none. */
  gdouble velocity_x;   /*!< Velocity of the motion that is felt, to the right, px/s. */
  gdouble velocity_y;   /*!< Velocity of the motion that is felt, downwards, px/s. */
  gdouble growth;       /*!< Relative change of lengths, 1/s; positive when it comes nearer. */
  gdouble roll;         /*!< Rotation of the picture, rad/s; positive is clockwise as seen. */
  gdouble force_x;      /*!< Wanted force to the right, N. */
  gdouble force_y;      /*!< Wanted force upwards, N. */
  gdouble force_z;      /*!< Wanted force towards the viewer, N. */
  gdouble torque_x;     /*!< Wanted torque about the x axis, N m, right-handed. */
  gdouble torque_y;     /*!< Wanted torque about the y axis, N m, right-handed. */
  gdouble torque_z;     /*!< Wanted torque about the z axis, N m, right-handed. */
} GstSpidarFrameMotion;

/*! Reads the motion of the frame in `buffer` into `motion`.
 *
 * Returns FALSE if the buffer has no such meta, because it was not analysed or attach-meta is not
 * set, or if the meta lacks a field; `motion` must then not be used. */
static inline gboolean gst_buffer_get_spidar_motion(GstBuffer* buffer,
                                                    GstSpidarFrameMotion* motion) {
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

/*! Returns whether the frame shows the previous picture again, so that the previous wrench remains
 * valid. FALSE if the buffer has no such meta. */
static inline gboolean gst_buffer_repeats_spidar_motion(GstBuffer* buffer) {
  GstCustomMeta* meta = gst_buffer_get_custom_meta(buffer, GST_SPIDAR_MOTION_META_NAME);
  gboolean repeated = FALSE;
  return meta != NULL &&
         gst_structure_get_boolean(gst_custom_meta_get_structure(meta), "repeated", &repeated) &&
         repeated;
}

/*! Returns the points of a frame, an array of GstSpidarMotionPoint, which the caller frees with
 * g_array_unref(). NULL if the buffer has no such meta; an empty array if nothing was tracked. */
static inline GArray* gst_buffer_get_spidar_points(GstBuffer* buffer) {
  GstCustomMeta* meta = gst_buffer_get_custom_meta(buffer, GST_SPIDAR_MOTION_META_NAME);
  GVariant* points = NULL;
  GVariantIter iter;
  GstSpidarMotionPoint point;
  GArray* result;
  if (meta == NULL || !gst_structure_get(gst_custom_meta_get_structure(meta), "points",
                                         G_TYPE_VARIANT, &points, NULL)) {
    return NULL;
  }
  result = g_array_new(FALSE, FALSE, sizeof(GstSpidarMotionPoint));
  g_variant_iter_init(&iter, points);
  while (g_variant_iter_next(&iter, "(uddddu)", &point.id, &point.from_x, &point.from_y,
                             &point.to_x, &point.to_y, &point.object)) {
    g_array_append_val(result, point);
  }
  g_variant_unref(points);
  return result;
}

G_END_DECLS

#endif
