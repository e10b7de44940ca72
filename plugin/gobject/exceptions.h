// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The border between C++ and GStreamer: an exception becomes an error message on the bus.
#pragma once

#include <exception>
#include <string>

#include <gst/gst.h>

namespace spidar {

/// Posts `error` as a message of the element, of the kind GST_MESSAGE_ERROR or GST_MESSAGE_WARNING.
/// A profile that is wrong or missing is RESOURCE/SETTINGS, a device that cannot be used is
/// RESOURCE/OPEN_READ_WRITE, anything else is LIBRARY/FAILED. `details` are the debug text.
void post_exception(GstElement* element, GstMessageType kind, const std::exception& error,
                    const std::string& details);

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
