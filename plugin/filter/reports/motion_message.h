// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The element message of a frame.
#pragma once

#include <gst/gst.h>

#include "plugin/filter/frame/frame_report.h"

namespace spidar {

/// While so many messages of an element wait on its bus, it posts no more of them: nobody reads
/// them, and they would fill the memory by hundreds of megabytes an hour. At 25 frames/s an
/// application that reads its bus has 40 s for it.
constexpr gint kMostUnread = 1000;

/// Posts `spidar-motion`, whose fields the documentation of the element lists. `unread` counts the
/// messages that exist, and lives as long as the element.
void post_motion_message(GstElement* element, GstBuffer* buffer, const FrameReport& report,
                         gint* unread);

}  // namespace spidar
