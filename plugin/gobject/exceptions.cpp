// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/gobject/exceptions.h"

#include "plugin/gobject/category.h"
#include "spidar/device.h"
#include "spidar/profiles/profile_file.h"
#include "spidar/session/profile_choice.h"

namespace spidar {

void post_exception(GstElement* element, GstMessageType kind, const std::exception& error,
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

}  // namespace spidar
