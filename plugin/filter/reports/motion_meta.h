// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Motion, tracks and wrench that travel with the frame.
#pragma once

#include <gst/video/video.h>

#include "plugin/filter/frame/frame_report.h"
#include "plugin/filter/frame/scene_view.h"

namespace spidar {

/// Makes the custom meta of gstspidarmotionmeta.h known; once a process is enough, more do no harm.
/// Where a frame is copied the meta goes along; where it is scaled, lengths and velocities are
/// scaled with it. An element that cuts, turns or otherwise changes the picture drops it.
void register_motion_meta();

/// `buffer` is writable; a meta of an element before this one is replaced. `width` and `height` are
/// those of the frame.
void attach_motion_meta(GstBuffer* buffer, const FrameReport& report, const SceneView& scene,
                        int width, int height);

}  // namespace spidar
