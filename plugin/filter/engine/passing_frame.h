// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A frame that passes the element.
#pragma once

#include <gst/video/video.h>

#include "core/analysis/frame.h"
#include "plugin/properties/motion_properties.h"

namespace spidar::filter {

struct PassingFrame {
  const GstVideoFrame& video;
  const GstSegment& segment;
  const FrameSettings& settings;
  const FrameStamp& stamp;
};

}  // namespace spidar::filter
