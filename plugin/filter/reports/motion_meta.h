// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The element's report of a frame in the meta that travels with it.
#pragma once

#include <gst/video/video.h>

#include "plugin/frame/frame_report.h"

namespace spidar::filter {

/// How GStreamer 1.28 and newer say that an element cuts, turns or mirrors a picture. GStreamer may
/// be newer at run time than at build time.
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

/// The type of a transformation whose data are a MatrixTransform.
inline GQuark matrix_transform() {
  return g_quark_from_static_string("gst-video-matrix");
}

/// Makes the custom meta of gstspidarmotionmeta.h known; one call in a process is enough, more do
/// no harm. Where a frame is copied, the meta is copied, too; where it is scaled, so are lengths
/// and velocities; from GStreamer 1.28 on, where it is cut, turned or mirrored, so are positions
/// and directions. Other elements that change the picture drop it.
void register_motion_meta();

/// `buffer` is writable; a meta of an element before this one is replaced. `width` and `height` are
/// those of the frame.
void attach_motion_meta(GstBuffer* buffer, const DrawnFrame& report, int width, int height);

}  // namespace spidar::filter
