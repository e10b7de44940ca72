// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The pipeline from a video to the screen and the grip.
#pragma once

#include <cstdint>
#include <string>

#include <gst/gst.h>

/// The sink for the picture.
struct Screen {
  GstElement* element = nullptr;  ///< for the pipeline; floating
  GstElement* sink = nullptr;     ///< the one in it that shows the frames; borrowed
  std::string why_none;           ///< why there is no window; empty when one is shown
};

/// A window or, without a display, a sink that only keeps time; so it is if the film is seen
/// `in_debug_window`.
Screen open_screen(bool headless, bool in_debug_window);

/// Number of frames that the sink has shown; 0 for a sink that does not count them.
uint64_t frames_shown(const Screen& screen);

/// The filter, to be configured by the caller. Throws std::runtime_error when the plugin is not
/// found.
GstElement* make_filter();

/// playbin with the filter between decoder and screen. `film` is a file or a URI.
GstElement* make_player(const std::string& film, GstElement* filter, const Screen& screen);

/// A ball that bounces for ten seconds, used when there is no video.
GstElement* make_ball(GstElement* filter, const Screen& screen);
