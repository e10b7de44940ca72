// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The element message of a frame.
#pragma once

#include <gst/gst.h>

#include "plugin/engine/motion_engine.h"

namespace spidar {

/// Posts `spidar-motion`, whose fields the documentation of the element lists.
void post_motion_message(GstElement* element, GstBuffer* buffer, const FrameReport& report);

}  // namespace spidar
