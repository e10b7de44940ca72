// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/gobject/exceptions.h"

#include "plugin/gobject/category.h"
#include "spidar/device.h"
#include "spidar/profiles/profile_file.h"

#undef GST_CAT_DEFAULT
#define GST_CAT_DEFAULT spidar::category_of(element)

namespace spidar {

void post_exception(GstElement* element, const std::exception& error, const char* doing) {
  if (dynamic_cast<const ProfileError*>(&error)) {
    GST_ELEMENT_ERROR(element, RESOURCE, SETTINGS, ("%s", error.what()), ("while %s", doing));
  } else if (dynamic_cast<const DeviceError*>(&error)) {
    GST_ELEMENT_ERROR(element, RESOURCE, OPEN_READ_WRITE, ("%s", error.what()),
                      ("while %s", doing));
  } else {
    GST_ELEMENT_ERROR(element, LIBRARY, FAILED, ("%s", error.what()), ("while %s", doing));
  }
}

}  // namespace spidar
