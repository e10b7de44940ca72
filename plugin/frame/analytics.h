// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Boxes of objects in a picture, as detectors attach them with GStreamer's analytics library
/// (GstAnalyticsRelationMeta). Without GStreamer 1.24 or newer, frames have none.
#pragma once

#include <cstdint>
#include <vector>

#include <gst/gst.h>

#include "plugin/frame/object_box.h"

namespace spidar {

/// Detections (GstAnalyticsODMtd) of others. Those of spidarmotion are regions as well, and are
/// left out.
std::vector<ObjectBox> read_detections(GstBuffer* buffer);

/// Attaches a box to `buffer`, which is writable, as a detection that is related to a track
/// (GstAnalyticsTrackingMtd) with the number `id`. What is attached cannot be taken away again.
void attach_detection(GstBuffer* buffer, const ObjectBox& box, uint32_t id);

}  // namespace spidar
