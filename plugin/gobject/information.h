// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Information messages on the bus.
#pragma once

#include <string>

#include <gst/gst.h>

#include "plugin/gobject/category.h"
#include "spidar/device.h"

namespace spidar {

/// Posts `text`, a sentence, for people. The debug text repeats it before `advice`, because
/// gst-launch-1.0 prints nothing else.
inline void post_information(GstElement* element, GQuark domain, gint code, const std::string& text,
                             const std::string& advice,
                             SourceLocation location = SourceLocation::here()) {
  GST_CAT_INFO_OBJECT(category_of(element), element, "%s", text.c_str());
  gst_element_message_full(element, GST_MESSAGE_INFO, domain, code, g_strdup(text.c_str()),
                           g_strdup((text + " " + advice).c_str()), location.file,
                           location.function, location.line);
}

}  // namespace spidar
