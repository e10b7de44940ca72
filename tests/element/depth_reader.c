/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Copyright 2026 the gst-spidar authors */
/* A program in C that reads the depth of a frame. */
#include <gst-spidar/gstspidardepthmeta.h>

gint first_sample_in_c (GstBuffer * frame);

/* -1 without depth. */
gint
first_sample_in_c (GstBuffer * frame)
{
  GstSpidarDepthImage image;
  GstVideoFrame mapped;
  gint sample;
  if (!gst_buffer_get_spidar_depth (frame, &image) ||
      !gst_video_frame_map (&mapped, &image.info, image.buffer, GST_MAP_READ))
    return -1;
  sample = *(const guint8 *) GST_VIDEO_FRAME_PLANE_DATA (&mapped, 0);
  gst_video_frame_unmap (&mapped);
  return sample;
}
