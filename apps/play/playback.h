// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Runs a pipeline and reports its messages.
#pragma once

#include <functional>
#include <string>

#include <gst/gst.h>

enum class Ending {
  kEndOfVideo,
  kInterrupted,  ///< Ctrl-C, told to terminate, or its window closed
  kFailed,
};

/// Plays until the video ends or fails, the user stops it, or `seconds` have passed (0: never).
/// Prints errors and warnings of the pipeline on standard error and `progress` on standard output:
/// in place on a terminal, otherwise a line from time to time. Afterwards the pipeline is still in
/// PLAYING or PAUSED.
Ending run_playback(GstElement* pipeline, int seconds,
                    const std::function<std::string()>& progress);
