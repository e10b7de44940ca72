// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What the element reports of a frame in the meta that travels with it.
#pragma once

#include <gst/gst.h>
#include <gst/video/video.h>

#include "plugin/frame/frame_report.h"

namespace spidar {

/// Makes the custom meta of gstspidarmotionmeta.h known; once a process is enough, more do no harm.
/// Where a frame is copied the meta goes along; where it is scaled, lengths and velocities are
/// scaled with it, and, from GStreamer 1.28 on, where it is cut, turned or mirrored, so are
/// positions and directions. Other elements that change the picture drop it.
void register_motion_meta();

/// `buffer` is writable; a meta of an element before this one is replaced. `width` and `height` are
/// those of the frame.
void attach_motion_meta(GstBuffer* buffer, const FrameReport& report, int width, int height);

}  // namespace spidar
