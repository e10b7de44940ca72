// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The report of a frame, or of a piece of a haptic track, as a message on the bus.
#pragma once

#include <gst/gst.h>

#include "plugin/frame/frame_report.h"

namespace spidar {

/// Posts `spidar-motion` with the fields of frame_fields(); see post_counted().
void post_motion_message(GstElement* element, GstClockTime timestamp, GstClockTime duration,
                         const FrameReport& report, gint* unread);

}  // namespace spidar
