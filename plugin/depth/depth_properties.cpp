// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/depth/depth_properties.h"

#include <cstdio>

#include "plugin/properties/property_table.h"

namespace spidar {
DepthMeaning DepthProperties::meaning(GstVideoFormat format) const {
  const bool disparity = samples == DepthSamples::kDisparity ||
                         (samples == DepthSamples::kAuto && format == GST_VIDEO_FORMAT_GRAY8);
  return {disparity, near_sample, far_sample};
}

std::string DepthProperties::trouble(GstVideoFormat format) const {
  if (near_sample < 0 || far_sample < 0) return {};
  const bool disparity = meaning(format).disparity;
  if (disparity ? near_sample > far_sample : near_sample < far_sample) return {};
  char text[200];
  std::snprintf(text, sizeof text,
                "With samples of %s 'near' must be %s than 'far', but near is %g and far is %g. "
                "-1 finds a value in the images; 'samples' says what samples mean.",
                disparity ? "disparity" : "distance", disparity ? "more" : "less", near_sample,
                far_sample);
  return text;
}

const PropertyTable<DepthProperties>& depth_properties() {
  using DepthRow = Property<DepthProperties>;
  // Never destroyed: a thread may still set a property while the process ends.
  static const auto& table = *new PropertyTable<DepthProperties>{{
      DepthRow::choice<DepthSamples>(
          {"samples", "Samples", "What the samples of depth mean"}, "GstSpidarDepthSamples",
          {{DepthSamples::kAuto, "GRAY8 is disparity, GRAY16 is distance", "auto"},
           {DepthSamples::kDistance, "Larger samples are farther", "distance"},
           {DepthSamples::kDisparity, "Larger samples are nearer", "disparity"}},
          kReady, KEPT_IN(samples)),
      DepthRow::number(
          {"near", "Near",
           "Sample that stands for the nearest depth, in units of the samples (often mm); "
           "-1: find it by percentiles"},
          -1, 65535, kReady, KEPT_IN(near_sample)),
      DepthRow::number(
          {"far", "Far",
           "Sample that stands for the farthest depth, in units of the samples; -1: find "
           "it by percentiles"},
          -1, 65535, kReady, KEPT_IN(far_sample)),
      DepthRow::duration(
          {"max-age", "Maximum age",
           "How long after its end a depth image is still attached while the next one is "
           "missing, ns; the largest value is for ever"},
          kPlaying, KEPT_IN(max_age_ns)),
  }};
  return table;
}

}  // namespace spidar
