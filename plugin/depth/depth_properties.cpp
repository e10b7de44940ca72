// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/depth/depth_properties.h"

#include <cstdio>

namespace spidar {
namespace {

constexpr auto kPlaying = static_cast<GParamFlags>(G_PARAM_READWRITE | G_PARAM_STATIC_STRINGS |
                                                   GST_PARAM_MUTABLE_PLAYING);
constexpr auto kReady =
    static_cast<GParamFlags>(G_PARAM_READWRITE | G_PARAM_STATIC_STRINGS | GST_PARAM_MUTABLE_READY);

enum DepthPropertyId : guint { kSamples = 1, kNear, kFar, kMaxAge };

GType depth_samples_type() {
  static const GType type = [] {
    static const GEnumValue values[] = {
        {static_cast<int>(DepthSamples::kAuto), "GRAY8 is disparity, GRAY16 is distance", "auto"},
        {static_cast<int>(DepthSamples::kDistance), "Larger samples are farther", "distance"},
        {static_cast<int>(DepthSamples::kDisparity), "Larger samples are nearer", "disparity"},
        {0, nullptr, nullptr}};
    return g_enum_register_static("GstSpidarDepthSamples", values);
  }();
  return type;
}

}  // namespace

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

void install_depth_properties(GObjectClass* c) {
  const DepthProperties defaults;
  g_object_class_install_property(
      c, kSamples,
      g_param_spec_enum("samples", "Samples", "What the samples of depth mean",
                        depth_samples_type(), static_cast<int>(defaults.samples), kReady));
  g_object_class_install_property(
      c, kNear,
      g_param_spec_double("near", "Near",
                          "Sample that stands for the nearest depth, in units of the samples "
                          "(often mm); -1: find it by percentiles",
                          -1, 65535, defaults.near_sample, kReady));
  g_object_class_install_property(
      c, kFar,
      g_param_spec_double("far", "Far",
                          "Sample that stands for the farthest depth, in units of the samples; "
                          "-1: find it by percentiles",
                          -1, 65535, defaults.far_sample, kReady));
  g_object_class_install_property(
      c, kMaxAge,
      g_param_spec_uint64("max-age", "Maximum age",
                          "How long after its end a depth image is still attached while the next "
                          "one is missing, ns; the largest value is for ever",
                          0, G_MAXUINT64, defaults.max_age_ns, kPlaying));
  gst_type_mark_as_plugin_api(depth_samples_type(), static_cast<GstPluginAPIFlags>(0));
}

bool set_depth_property(DepthProperties& p, guint id, const GValue* value) {
  switch (id) {
    case kSamples:
      p.samples = static_cast<DepthSamples>(g_value_get_enum(value));
      return true;
    case kNear:
      p.near_sample = g_value_get_double(value);
      return true;
    case kFar:
      p.far_sample = g_value_get_double(value);
      return true;
    case kMaxAge:
      p.max_age_ns = g_value_get_uint64(value);
      return true;
    default:
      return false;
  }
}

bool get_depth_property(const DepthProperties& p, guint id, GValue* value) {
  switch (id) {
    case kSamples:
      g_value_set_enum(value, static_cast<int>(p.samples));
      return true;
    case kNear:
      g_value_set_double(value, p.near_sample);
      return true;
    case kFar:
      g_value_set_double(value, p.far_sample);
      return true;
    case kMaxAge:
      g_value_set_uint64(value, p.max_age_ns);
      return true;
    default:
      return false;
  }
}

}  // namespace spidar
