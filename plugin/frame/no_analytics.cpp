// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// In a build without GStreamer's analytics library.
#include "plugin/frame/analytics.h"

namespace spidar {

std::vector<ObjectBox> read_detections(GstBuffer*) {
  return {};
}

void attach_detection(GstBuffer*, const ObjectBox&, uint32_t) {}

}  // namespace spidar
