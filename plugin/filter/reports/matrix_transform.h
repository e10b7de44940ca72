// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// How GStreamer 1.28 and newer say that an element cuts, turns or mirrors a picture. It may be
/// newer at run time than where this is built.
#pragma once

#include <gst/video/video.h>

namespace spidar {

#if GST_CHECK_VERSION(1, 28, 0)
using MatrixTransform = GstVideoMetaTransformMatrix;
#else
/// GstVideoMetaTransformMatrix of gstvideometa.h: `matrix` maps homogeneous coordinates inside the
/// one rectangle to those inside the other, from the corner at their top left, x right, y down.
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

}  // namespace spidar
