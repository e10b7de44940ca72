// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/feel/feel_caps.h"

#include "plugin/gobject/ref.h"

namespace spidar {
namespace {

constexpr const char* kSides[] = {"width", "height"};

/// Width or height in the first structure of `caps`, a number or a range; nullptr: any.
const GValue* side_of(const GstCaps* caps, const char* side) {
  return gst_structure_get_value(gst_caps_get_structure(caps, 0), side);
}

std::string text_of(const GValue* value) {
  if (!value) return "any";
  if (GST_VALUE_HOLDS_INT_RANGE(value))
    return std::to_string(gst_value_get_int_range_min(value)) + " to " +
           std::to_string(gst_value_get_int_range_max(value));
  gchar* text = gst_value_serialize(value);
  const std::string result = text ? text : "?";
  g_free(text);
  return result;
}

}  // namespace

GstCaps* motion_caps() {
  const Ref<GstElementFactory> factory(gst_element_factory_find("spidarmotion"));
  if (!factory) return nullptr;
  GstCaps* caps = nullptr;
  for (const GList* item = gst_element_factory_get_static_pad_templates(factory.get()); item;
       item = item->next) {
    auto* pad = static_cast<GstStaticPadTemplate*>(item->data);
    if (pad->direction == GST_PAD_SINK && !caps) caps = gst_static_pad_template_get_caps(pad);
  }
  return caps;
}

GstCaps* in_any_size(const GstCaps* caps) {
  GstCaps* result = gst_caps_copy(caps);
  for (guint i = 0; i < gst_caps_get_size(result); ++i)
    gst_structure_remove_fields(gst_caps_get_structure(result, i), kSides[0], kSides[1], nullptr);
  return result;
}

bool fits_size(const GstCaps* video, const GstCaps* accepted) {
  for (const char* side : kSides) {
    const GValue* has = side_of(video, side);
    const GValue* may_have = side_of(accepted, side);
    if (has && may_have && !gst_value_intersect(nullptr, has, may_have)) return false;
  }
  return true;
}

std::string say_sizes(const GstCaps* video, const GstCaps* accepted) {
  return "frames of " + text_of(side_of(video, "width")) + "x" + text_of(side_of(video, "height")) +
         " pixels are not felt; spidarmotion accepts widths of " +
         text_of(side_of(accepted, "width")) + " and heights of " +
         text_of(side_of(accepted, "height")) + " pixels";
}

}  // namespace spidar
