/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Copyright 2026 the gst-spidar authors */
/* A program in C that reads the meta. */
#include <gst-spidar/gstspidarmotionmeta.h>
#include <gst-spidar/gstspidarobjectmeta.h>

gboolean read_motion_in_c (GstBuffer * buffer, GstSpidarFrameMotion * motion);
GArray *read_tracks_in_c (GstBuffer * buffer);
GArray *read_objects_in_c (GstBuffer * buffer);

gboolean
read_motion_in_c (GstBuffer * buffer, GstSpidarFrameMotion * motion)
{
  return gst_buffer_get_spidar_motion (buffer, motion);
}

GArray *
read_tracks_in_c (GstBuffer * buffer)
{
  return gst_buffer_get_spidar_points (buffer);
}

GArray *
read_objects_in_c (GstBuffer * buffer)
{
  return gst_buffer_get_spidar_objects (buffer);
}
