// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The objects of a frame, as elements of other projects read them.
#pragma once

#include <gst/video/video.h>

#include "plugin/filter/frame/frame_report.h"

namespace spidar {

/// The name of our objects.
constexpr const char* kObjectName = "spidar-object";

/// Attaches the objects in sight to `buffer`, which is writable, as GstVideoRegionOfInterestMeta.
/// Those that another spidarmotion has attached are replaced.
void attach_object_metas(GstBuffer* buffer, const FrameReport& report, int width, int height);

}  // namespace spidar
