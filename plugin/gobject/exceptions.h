// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The border between C++ and GStreamer: an exception becomes an error message on the bus.
#pragma once

#include <exception>
#include <string>

#include <gst/gst.h>

#include "plugin/gobject/category.h"
#include "spidar/device.h"
#include "spidar/profiles/profile_file.h"
#include "spidar/session/profile_choice.h"

namespace spidar {

/// Posts `error` as a message of the element, of the kind GST_MESSAGE_ERROR or GST_MESSAGE_WARNING.
/// A profile that is wrong or missing is RESOURCE/SETTINGS, a device that cannot be used is
/// RESOURCE/OPEN_READ_WRITE, anything else is LIBRARY/FAILED. `details` are the debug text.
inline void post_exception(GstElement* element, GstMessageType kind, const std::exception& error,
                           const std::string& details) {
  GQuark domain = GST_RESOURCE_ERROR;
  gint code = GST_RESOURCE_ERROR_SETTINGS;
  if (!dynamic_cast<const ProfileError*>(&error) && !dynamic_cast<const NoProfile*>(&error)) {
    const bool is_device = dynamic_cast<const DeviceError*>(&error) != nullptr;
    domain = is_device ? GST_RESOURCE_ERROR : GST_LIBRARY_ERROR;
    code = is_device ? static_cast<gint>(GST_RESOURCE_ERROR_OPEN_READ_WRITE)
                     : static_cast<gint>(GST_LIBRARY_ERROR_FAILED);
  }
  // As the macros of GStreamer that post a message also log it.
  GST_CAT_WARNING_OBJECT(category_of(element), element, "%s: %s",
                         kind == GST_MESSAGE_ERROR ? "error" : "warning", error.what());
  gst_element_message_full(element, kind, domain, code, g_strdup(error.what()),
                           g_strdup(details.c_str()), __FILE__, GST_FUNCTION, __LINE__);
}

/// Calls `function`. When it throws, posts the exception as an error and returns false. `doing`
/// completes "while …" in the debug text.
template <typename Function>
bool guarded(GstElement* element, const char* doing, Function&& function) {
  try {
    function();
    return true;
  } catch (const std::exception& error) {
    post_exception(element, GST_MESSAGE_ERROR, error, std::string("while ") + doing);
    return false;
  }
}

}  // namespace spidar
