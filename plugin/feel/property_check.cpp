// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/feel/property_check.h"

#include <string>

#include "spidar/session/device_factory.h"
#include "spidar/session/profile_choice.h"

namespace spidar {
namespace {

void check_one(GObject* element, const std::string& text) {
  const TypedProperty property(element, text);
  const std::string name = property.name();
  if (name == "device" || name == "profile")
    g_object_set_property(element, name.c_str(), property.value());
}

std::string string_property(GObject* element, const char* name) {
  gchar* text = nullptr;
  g_object_get(element, name, &text, nullptr);
  const std::string result = text ? text : "";
  g_free(text);
  return result;
}

void check_device(GObject* element) {
  const std::string device = string_property(element, "device");
  const std::string profile = string_property(element, "profile");
  try {
    if (device != "none")
      make_grip(device, profile_for(device, profile));
    else if (!profile.empty())
      load_profile(profile);
  } catch (const std::exception& error) {
    throw PropertyError(error.what());
  }
}

}  // namespace

void check_properties(GstElement* element, const std::vector<std::string>& properties) {
  for (const std::string& property : properties) check_one(G_OBJECT(element), property);
  check_device(G_OBJECT(element));
}

}  // namespace spidar
