// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/filter/frame/analytics_meta.h"

namespace spidar {

const bool kHasAnalytics = false;

void read_analytics_meta(GstBuffer*, std::vector<ObjectBox>&) {}
void attach_analytics_meta(GstBuffer*, const std::vector<ObjectBox>&) {}

}  // namespace spidar
