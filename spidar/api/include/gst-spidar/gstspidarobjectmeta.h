/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Copyright 2026 the gst-spidar authors */
/*! \file
 * Reads in C the objects that spidarmotion with attach-meta=true attaches to a frame, as regions. A
 * program has to link gstreamer-video-1.0, not the plugin. docs/meta.md shows how other languages
 * read them. */
#ifndef GST_SPIDAR_OBJECT_META_H
#define GST_SPIDAR_OBJECT_META_H

#include <string.h>

#include <gst/gst.h>
#include <gst/video/video.h>

G_BEGIN_DECLS

/*! Type of the region (GstVideoRegionOfInterestMeta) of an object. */
#define GST_SPIDAR_OBJECT_TYPE "spidar-object"
/*! Name of the structure of such a region. */
#define GST_SPIDAR_OBJECT_PARAM "spidar-motion"

/*! An object that moves against the background. x to the right, y down. */
typedef struct {
  guint id;                  /*!< Stays the same as long as the object exists. */
  guint x;                   /*!< Left edge of its box, px of this frame. */
  guint y;                   /*!< Upper edge of its box, px. */
  guint w;                   /*!< Width of its box, px. */
  guint h;                   /*!< Height of its box, px. */
  guint frame_width;         /*!< Width of the frame that velocities refer to, px. */
  guint frame_height;        /*!< Height of that frame, px. */
  gdouble velocity_x;        /*!< Velocity against the background, to the right, px/s. */
  gdouble velocity_y;        /*!< Velocity against the background, downwards, px/s. */
  gdouble velocity_error;    /*!< The true velocity is less than this away in 95 % of the frames,
                              * px/s. */
  gdouble screen_velocity_x; /*!< Velocity on the screen, to the right, px/s. */
  gdouble screen_velocity_y; /*!< Velocity on the screen, downwards, px/s. */
  gdouble growth;            /*!< Relative change of lengths, 1/s; positive when it comes nearer. */
  gdouble roll;              /*!< Rotation, rad/s; positive is clockwise as seen. */
  gboolean felt;             /*!< Whether this object is the felt one. */
} GstSpidarObject;

/*! Returns the objects of a frame, an array of GstSpidarObject, which the caller frees with
 * g_array_unref(); empty if there are none, or if the frame was not analysed
 * (gst_buffer_get_spidar_motion() then returns FALSE). */
static inline GArray* gst_buffer_get_spidar_objects(GstBuffer* buffer) {
  GArray* objects = g_array_new(FALSE, FALSE, sizeof(GstSpidarObject));
  const GQuark type = g_quark_from_static_string(GST_SPIDAR_OBJECT_TYPE);
  gpointer state = NULL;
  GstMeta* meta;
  while ((meta = gst_buffer_iterate_meta_filtered(
              buffer, &state, GST_VIDEO_REGION_OF_INTEREST_META_API_TYPE)) != NULL) {
    GstVideoRegionOfInterestMeta* region = (GstVideoRegionOfInterestMeta*)meta;
    GstStructure* motion =
        gst_video_region_of_interest_meta_get_param(region, GST_SPIDAR_OBJECT_PARAM);
    GstSpidarObject object;
    memset(&object, 0, sizeof object);
    if (region->roi_type != type || motion == NULL ||
        !gst_structure_get(motion, "width", G_TYPE_UINT, &object.frame_width, "height", G_TYPE_UINT,
                           &object.frame_height, "velocity-x", G_TYPE_DOUBLE, &object.velocity_x,
                           "velocity-y", G_TYPE_DOUBLE, &object.velocity_y, "velocity-error",
                           G_TYPE_DOUBLE, &object.velocity_error, "screen-velocity-x",
                           G_TYPE_DOUBLE, &object.screen_velocity_x, "screen-velocity-y",
                           G_TYPE_DOUBLE, &object.screen_velocity_y, "growth", G_TYPE_DOUBLE,
                           &object.growth, "roll", G_TYPE_DOUBLE, &object.roll, "felt",
                           G_TYPE_BOOLEAN, &object.felt, NULL)) {
      continue;
    }
    object.id = (guint)region->id;
    object.x = region->x;
    object.y = region->y;
    object.w = region->w;
    object.h = region->h;
    g_array_append_val(objects, object);
  }
  return objects;
}

G_END_DECLS

#endif
