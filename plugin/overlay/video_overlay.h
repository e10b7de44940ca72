// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Draws motion, force and contact into the video.
#pragma once

#include <optional>

#include <gst/video/video.h>

#include "plugin/frame/scene_view.h"
#include "plugin/frame/touch_view.h"

namespace spidar {

/// Draws one arrow per track, a cross at each lost point, and the felt force as a white arrow with
/// a black border from the centre of `visible`. With `touch`, also draws the finger as a ring, the
/// touched point as a disc that grows with the force, and the contact force from that point.
/// `frame` must be mapped for writing and have one of SPIDAR_VIDEO_FORMATS.
void draw_overlay(const SceneView& scene, const VisiblePart& visible, double scale,
                  double max_force_N, const std::optional<TouchMark>& touch, GstVideoFrame& frame);

}  // namespace spidar
