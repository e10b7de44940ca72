// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// From a video to the screen and the grip.
#pragma once

#include <string>

#include <gst/gst.h>

/// Where the picture goes.
struct Screen {
  GstElement* element = nullptr;  ///< for the pipeline; floating
  GstElement* sink = nullptr;     ///< the GstBaseSink in it; borrowed
  std::string why_none;           ///< empty when a window is shown
};

/// A window, or without a display a sink that only keeps time.
Screen open_screen(bool headless);

/// The filter to be set up. Throws std::runtime_error when the plugin is not found.
GstElement* make_filter();

/// playbin with the filter between decoder and screen.
GstElement* make_player(const std::string& uri, GstElement* filter, const Screen& screen);

/// A ball that jumps about for ten seconds, for want of a video.
GstElement* make_ball(GstElement* filter, const Screen& screen);
