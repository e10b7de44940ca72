// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What is felt, drawn into the video itself.
#pragma once

#include <optional>

#include <gst/video/video.h>

#include "plugin/overlay/scene_view.h"
#include "plugin/overlay/touch_view.h"

namespace spidar {

/// Draws one arrow a track, a cross where a point was lost, and the felt force as a white arrow
/// with a black border from the middle of `visible` on. With a `touch`, also the finger as a ring,
/// the touched point as a disc that grows with the force, and the force of the contact from there.
/// `frame` is mapped for writing and of one of SPIDAR_VIDEO_FORMATS.
void draw_overlay(const SceneView& scene, const VisiblePart& visible, double scale,
                  double max_force_N, const std::optional<TouchMark>& touch, GstVideoFrame& frame);

}  // namespace spidar
