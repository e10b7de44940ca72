// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// GstAnalyticsRelationMeta, which GStreamer has since 1.24. Built for an older one, these do
/// nothing.
#pragma once

#include <vector>

#include <gst/gst.h>

#include "plugin/filter/frame/object_metas.h"

namespace spidar {

extern const bool kHasAnalytics;

/// Appends what detectors found, with the track of it where a tracker says it.
void read_analytics_meta(GstBuffer* buffer, std::vector<ObjectBox>& boxes);

/// Adds each box as a detection and a track that relate to each other.
void attach_analytics_meta(GstBuffer* buffer, const std::vector<ObjectBox>& boxes);

}  // namespace spidar
