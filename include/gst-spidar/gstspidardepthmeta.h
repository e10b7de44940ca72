/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Copyright 2026 the gst-spidar authors */
/* The depth image that spidardepth attaches to a frame: how to read it in C. The plugin need not be
 * linked, gstreamer-video has to be. docs/meta.md has the fields. */
#ifndef GST_SPIDAR_DEPTH_META_H
#define GST_SPIDAR_DEPTH_META_H

#include <string.h>

#include <gst/gst.h>
#include <gst/video/video.h>

G_BEGIN_DECLS

/* Name of the custom meta (gst_buffer_get_custom_meta()) and of its structure. */
#define GST_SPIDAR_DEPTH_META_NAME "GstSpidarDepthMeta"

typedef struct {
  GstBuffer* buffer;   /* belongs to the frame's meta: to be referenced if it is kept for longer */
  GstVideoInfo info;   /* GRAY8, GRAY16_LE or GRAY16_BE, of a size of its own */
  gint64 running_time; /* ns, of the depth image; that of the frame may be another */
  gboolean disparity;  /* TRUE: larger samples are nearer, FALSE: they are farther */
  gdouble near_sample; /* sample that is nearest; below 0: find it by percentiles */
  gdouble far_sample;  /* sample that is farthest; below 0: find it by percentiles */
} GstSpidarDepthImage;

/* FALSE when the frame has no such meta: no depth belongs to it. Map it with
 * gst_video_frame_map (&mapped, &image.info, image.buffer, GST_MAP_READ). */
static inline gboolean gst_buffer_get_spidar_depth(GstBuffer* frame, GstSpidarDepthImage* image) {
  GstCustomMeta* meta = gst_buffer_get_custom_meta(frame, GST_SPIDAR_DEPTH_META_NAME);
  GstStructure* structure;
  const GValue* buffer;
  const GValue* caps;
  memset(image, 0, sizeof *image);
  if (meta == NULL) return FALSE;
  structure = gst_custom_meta_get_structure(meta);
  buffer = gst_structure_get_value(structure, "depth");
  caps = gst_structure_get_value(structure, "caps");
  if (buffer == NULL || caps == NULL) return FALSE;
  image->buffer = gst_value_get_buffer(buffer);
  return gst_video_info_from_caps(&image->info, gst_value_get_caps(caps)) &&
         gst_structure_get(structure, "running-time", G_TYPE_INT64, &image->running_time,
                           "disparity", G_TYPE_BOOLEAN, &image->disparity, "near", G_TYPE_DOUBLE,
                           &image->near_sample, "far", G_TYPE_DOUBLE, &image->far_sample, NULL);
}

G_END_DECLS

#endif
