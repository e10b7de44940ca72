/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Copyright 2026 the gst-spidar authors */
/*! \file
 * Reads in C the depth image that spidardepth attaches to a frame. A program has to link
 * gstreamer-video, not the plugin. docs/meta.md lists the fields. */
/* Comments for Doxygen begin with an exclamation mark, because the tools of GObject introspection
 * take two asterisks for comments of their own. */
#ifndef GST_SPIDAR_DEPTH_META_H
#define GST_SPIDAR_DEPTH_META_H

#include <string.h>

#include <gst/gst.h>
#include <gst/video/video.h>

G_BEGIN_DECLS

/*! Name of the custom meta (gst_buffer_get_custom_meta()) and of its structure. */
#define GST_SPIDAR_DEPTH_META_NAME "GstSpidarDepthMeta"

/*! The depth of one frame. */
typedef struct {
  /*! The depth image. The meta of the frame owns it: take a reference of your own, with
   * gst_buffer_ref(), to use it longer than the frame. */
  GstBuffer* buffer;
  /*! Format of the depth image, which is GRAY8, GRAY16_LE or GRAY16_BE, and its size in pixels,
   * which may differ from that of the frame. Both cover the same picture. */
  GstVideoInfo info;
  /*! Running time of the depth image, ns. The frame's own may differ. */
  gint64 running_time;
  gboolean disparity;  /*!< TRUE if larger samples are nearer, FALSE if they are farther. */
  gdouble near_sample; /*!< Sample of the nearest point; negative: find it by percentiles. */
  gdouble far_sample;  /*!< Sample of the farthest point; negative: find it by percentiles. */
} GstSpidarDepthImage;

/*! Reads the depth image of `frame` into `image`.
 *
 * Returns FALSE if no depth belongs to the frame, or if the meta lacks a field; `image` is then not
 * to be used. Map the depth image with
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
