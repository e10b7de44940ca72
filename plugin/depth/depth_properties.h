// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Properties of the element spidardepth.
#pragma once

#include <string>

#include <gst/gst.h>
#include <gst/video/video.h>

#include "plugin/depth/depth_meta.h"

namespace spidar {

template <typename Settings>
class PropertyTable;

enum class DepthSamples { kAuto, kDistance, kDisparity };

struct DepthProperties {
  DepthSamples samples = DepthSamples::kAuto;
  double near_sample = -1;
  double far_sample = -1;
  guint64 max_age_ns = 250 * GST_MSECOND;

  /// The meaning of the samples for an image of this format.
  DepthMeaning meaning(GstVideoFormat format) const;
  /// Describes what is wrong with near and far for this format and how to correct it; empty if they
  /// are valid.
  std::string trouble(GstVideoFormat format) const;
};

/// All of spidardepth.
const PropertyTable<DepthProperties>& depth_properties();

}  // namespace spidar
