// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <exception>
#include <stdexcept>
#include <string>

#include <gst/gst.h>

#include "plugin/gobject/category.h"
#include "spidar/device.h"
#include "spidar/profiles/profile.h"

namespace spidar {

inline GstResourceError resource_error(DeviceErrorCode code) {
  switch (code) {
    case DeviceErrorCode::kAbsent:
      return GST_RESOURCE_ERROR_NOT_FOUND;
    case DeviceErrorCode::kBusy:
      return GST_RESOURCE_ERROR_BUSY;
    case DeviceErrorCode::kForbidden:
      return GST_RESOURCE_ERROR_NOT_AUTHORIZED;
    case DeviceErrorCode::kSettings:
      return GST_RESOURCE_ERROR_SETTINGS;
    case DeviceErrorCode::kFailed:
      break;
  }
  return GST_RESOURCE_ERROR_OPEN_READ_WRITE;
}

/// Posts `error` as a message of the element, of the kind GST_MESSAGE_ERROR or GST_MESSAGE_WARNING.
/// A device that cannot be used is RESOURCE with resource_error() of its code, a wrong profile or
/// number RESOURCE/SETTINGS, anything else LIBRARY/FAILED. The debug text begins with the line of
/// the source that found the error, or `location` without one, and ends with `details`.
inline void post_exception(GstElement* element, GstMessageType kind, const std::exception& error,
                           const std::string& details, SourceLocation location) {
  const auto* const device = dynamic_cast<const DeviceError*>(&error);
  const bool is_setting = dynamic_cast<const ProfileError*>(&error) != nullptr ||
                          dynamic_cast<const std::invalid_argument*>(&error) != nullptr;
  const GQuark domain = device || is_setting ? GST_RESOURCE_ERROR : GST_LIBRARY_ERROR;
  gint code = GST_LIBRARY_ERROR_FAILED;
  if (is_setting) code = GST_RESOURCE_ERROR_SETTINGS;
  if (device) {
    code = resource_error(device->code());
    location = device->location();
  }
  // GStreamer's macros that post a message also log it.
  GST_CAT_WARNING_OBJECT(category_of(element), element, "%s: %s",
                         kind == GST_MESSAGE_ERROR ? "error" : "warning", error.what());
  gst_element_message_full(element, kind, domain, code, g_strdup(error.what()),
                           g_strdup(details.c_str()), location.file, location.function,
                           location.line);
}

/// Posts `text`, a sentence, for people. The debug text repeats the sentence before `advice`,
/// because gst-launch-1.0 prints nothing else.
inline void post_information(GstElement* element, GQuark domain, gint code, const std::string& text,
                             const std::string& advice,
                             SourceLocation location = SourceLocation::here()) {
  GST_CAT_INFO_OBJECT(category_of(element), element, "%s", text.c_str());
  gst_element_message_full(element, GST_MESSAGE_INFO, domain, code, g_strdup(text.c_str()),
                           g_strdup((text + " " + advice).c_str()), location.file,
                           location.function, location.line);
}

}  // namespace spidar
