// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The border between C++ and GStreamer: an exception becomes an error message on the bus.
#pragma once

#include <exception>

#include <gst/gst.h>

namespace spidar {

/// Posts `error` as the element's error message. A wrong profile is RESOURCE/SETTINGS, a device
/// that cannot be used is RESOURCE/OPEN_READ_WRITE, anything else is LIBRARY/FAILED. `doing`
/// completes "while …" in the debug text.
void post_exception(GstElement* element, const std::exception& error, const char* doing);

/// Calls `function`. When it throws, posts the exception and returns false.
template <typename Function>
bool guarded(GstElement* element, const char* doing, Function&& function) {
  try {
    function();
    return true;
  } catch (const std::exception& error) {
    post_exception(element, error, doing);
    return false;
  }
}

}  // namespace spidar
