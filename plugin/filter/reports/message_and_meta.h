// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What the element tells of a frame: the message on the bus, and the meta that travels with it.
#pragma once

#include <gst/gst.h>
#include <gst/video/video.h>

#include "plugin/frame/frame_report.h"

namespace spidar {

/// Makes the custom meta of gstspidarmotionmeta.h known; once a process is enough, more do no harm.
/// Where a frame is copied the meta goes along; where it is scaled, lengths and velocities are
/// scaled with it, and, from GStreamer 1.28 on, where it is cut, turned or mirrored, so are places
/// and directions. Other elements that change the picture drop it.
void register_motion_meta();

/// `buffer` is writable; a meta of an element before this one is replaced. `width` and `height` are
/// those of the frame.
void attach_motion_meta(GstBuffer* buffer, const FrameReport& report, int width, int height);

/// While so many messages of an element wait on its bus, it posts no more of them: nobody reads
/// them, and they would fill the memory by hundreds of megabytes an hour. At 25 frames/s an
/// application that reads its bus has 40 s for it.
constexpr gint kMostUnread = 1000;

/// Posts `spidar-motion`, whose fields the documentation of the element lists. `unread` counts the
/// messages that exist, and lives as long as the element.
void post_motion_message(GstElement* element, GstBuffer* buffer, const FrameReport& report,
                         gint* unread);

}  // namespace spidar
