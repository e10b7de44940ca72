// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstdint>
#include <string>

#include <gst/gst.h>

/// The sink for the picture.
struct Screen {
  GstElement* element = nullptr;  ///< for the pipeline; floating
  GstElement* sink = nullptr;     ///< the sink in it that shows the frames; borrowed
  std::string why_none;           ///< why there is no window; empty when there is one
};

/// Opens a window or, without a display, a sink that only keeps time; also when the film is shown
/// `in_debug_window`.
Screen open_screen(bool headless, bool in_debug_window);

/// The number of frames that the sink has shown; 0 for a sink that does not count.
uint64_t frames_shown(const Screen& screen);

/// The filter, for the caller to configure. Throws std::runtime_error when the plugin is missing.
GstElement* make_filter();

/// A playbin with the filter between decoder and screen. `film` is a file or a URI.
GstElement* make_player(const std::string& film, GstElement* filter, const Screen& screen);

/// A ball that bounces for ten seconds, in place of a video.
GstElement* make_ball(GstElement* filter, const Screen& screen);
