// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/feel/follow/felt_element.h"

#include <cstdio>
#include <stdexcept>

#include <gst/pbutils/pbutils.h>

#include "plugin/gobject/set_text.h"
#include "spidar/text.h"

namespace spidar::follow {

void print_message(const std::string& text) {
  constexpr size_t kMax = 1000;
  const std::string shown =
      text.size() <= kMax ? text
                          : text.substr(0, kMax / 2) + " … " + text.substr(text.size() - kMax / 2);
  // g_printerr() would replace letters that the locale of the process, "C", does not have.
  std::fprintf(stderr, "spidar-feel: %s\n", printable(shown).c_str());
}

GstElement* parse_pipeline(const std::string& line) {
  g_autoptr(GError) error = nullptr;
  GstElement* pipeline = gst_parse_launch(line.c_str(), &error);
  if (!error) return pipeline;
  gst_clear_object(&pipeline);
  throw std::runtime_error(error->message);
}

const char* value_of(const std::vector<std::string>& properties, const std::string& name) {
  const char* value = nullptr;
  for (const std::string& property : properties) {
    if (property.rfind(name + "=", 0) == 0) value = property.c_str() + name.size() + 1;
  }
  return value;
}

std::optional<bool> wants_window(const std::vector<std::string>& properties) {
  const char* const window = value_of(properties, "debug-window");
  if (!window) return std::nullopt;
  GValue wanted = G_VALUE_INIT;
  g_value_init(&wanted, G_TYPE_BOOLEAN);
  return gst_value_deserialize(&wanted, window) && g_value_get_boolean(&wanted);
}

bool has_display() {
  const auto is_set = [](const char* name) {
    const char* const value = g_getenv(name);
    return value && *value;
  };
  return is_set("DISPLAY") || is_set("WAYLAND_DISPLAY");
}

std::string set_properties(GstElement* felt, const std::vector<std::string>& properties) {
  std::string others;
  for (const std::string& property : properties) {
    const std::string unknown = set_text(felt, property);
    if (unknown.empty() || unknown == "debug-window") continue;
    others += (others.empty() ? "" : ", ") + unknown;
  }
  return others;
}

std::string text_for_people(GstMessage* message) {
  g_autoptr(GError) error = nullptr;
  switch (GST_MESSAGE_TYPE(message)) {
    case GST_MESSAGE_ERROR:
      gst_message_parse_error(message, &error, nullptr);
      break;
    case GST_MESSAGE_WARNING:
      gst_message_parse_warning(message, &error, nullptr);
      break;
    case GST_MESSAGE_INFO:
      gst_message_parse_info(message, &error, nullptr);
      break;
    default:
      if (!gst_is_missing_plugin_message(message)) return "";
      g_autofree gchar* what = gst_missing_plugin_message_get_description(message);
      return std::string("not installed for GStreamer: ") + what +
             "; Debian has most decoders in gstreamer1.0-libav";
  }
  return error->message;
}

std::optional<bool> parse_is_simulated(GstMessage* message) {
  const GstStructure* const told = gst_message_get_structure(message);
  gboolean simulated = FALSE;
  if (!told || !gst_structure_has_name(told, "spidar-device") ||
      !gst_structure_get_boolean(told, "simulated", &simulated)) {
    return std::nullopt;
  }
  return simulated != FALSE;
}

}  // namespace spidar::follow
