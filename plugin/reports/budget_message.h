// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The message when the budget of processor time changes how much of the analysis is done.
#pragma once

#include <gst/gst.h>

#include "plugin/frame/frame_report.h"

namespace spidar {

/// Posts GStreamer's QoS message if the rung of a frame is not that of the frame before. Its
/// quality is 1 000 000 on rung 0, as GStreamer has it, and a fifth less on each next one. Its
/// proportion is the time that the frame took over the budget; no frame is dropped.
void post_budget_message(GstElement* element, GstBuffer* buffer, const FrameReport& report,
                         guint64 frames);

}  // namespace spidar
