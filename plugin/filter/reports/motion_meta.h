// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <gst/video/video.h>

#include "plugin/frame/frame_report.h"

namespace spidar::filter {

/// The data with which GStreamer 1.28 and newer describe that an element crops, turns or mirrors a
/// picture. Declared here too, because GStreamer may be newer at run time than at build time.
#if GST_CHECK_VERSION(1, 28, 0)
using MatrixTransform = GstVideoMetaTransformMatrix;
#else
/// GstVideoMetaTransformMatrix of gstvideometa.h: `matrix` maps homogeneous coordinates in
/// `in_rectangle` to those in `out_rectangle`, each from its top left corner, x right, y down.
struct MatrixTransform {
  const GstVideoInfo* in_info;
  GstVideoRectangle in_rectangle;
  const GstVideoInfo* out_info;
  GstVideoRectangle out_rectangle;
  gfloat matrix[3][3];
};
#endif

inline GQuark matrix_transform() {
  return g_quark_from_static_string("gst-video-matrix");
}

/// Registers the custom meta of gstspidarmotionmeta.h; may be called more than once. A copy of a
/// frame has a copy of the meta. Scaling a frame scales lengths and velocities; from GStreamer 1.28
/// on, cropping, turning and mirroring also map positions and directions. Other elements that
/// change the picture drop the meta.
void register_motion_meta();

/// Attaches the report to `buffer`, which must be writable, and replaces the meta of an earlier
/// element. `width` and `height` are those of the frame.
void attach_motion_meta(GstBuffer* buffer, const DrawnFrame& report, int width, int height);

}  // namespace spidar::filter
