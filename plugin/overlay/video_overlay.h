// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Draws motion, force and contact into the video.
#pragma once

#include <gst/video/video.h>

#include "plugin/frame/frame_report.h"
#include "plugin/overlay/force_curve.h"

namespace spidar {

/// Draws the box of each object, thick if it is felt, and the wanted force in newtons as a white
/// arrow with a black border, which begins on the object (see force_origin_px()). While the picture
/// is touched, also draws the finger as a ring, the touched point as a disc that grows with the
/// force, and the contact force from that point. With `has_points`, also draws one arrow per point
/// and a cross at each lost point; with a `curve`, that along the lower edge. `frame` must be
/// mapped for writing.
void draw_overlay(const FrameReport& report, bool has_points, double scale, GstVideoFrame& frame,
                  const ForceCurve* curve = nullptr);

}  // namespace spidar
