// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Sets properties from text that was checked before.
#pragma once

#include <string>

#include <gst/gst.h>

namespace spidar {

/// Sets NAME=VALUE of `element`, or loads its preset for preset=NAME. Returns the name if `element`
/// has no such property, else empty.
inline std::string set_text(GstElement* element, const std::string& property) {
  const size_t end = property.find('=');
  const std::string name = property.substr(0, end), value = property.substr(end + 1);
  if (name == "preset" && GST_IS_PRESET(element)) {
    gst_preset_load_preset(GST_PRESET(element), value.c_str());
  } else if (g_object_class_find_property(G_OBJECT_GET_CLASS(element), name.c_str())) {
    gst_util_set_object_arg(G_OBJECT(element), name.c_str(), value.c_str());
  } else {
    return name;
  }
  return {};
}

}  // namespace spidar
