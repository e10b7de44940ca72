// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A pipeline at work.
#pragma once

#include <functional>
#include <string>

#include <gst/gst.h>

enum class Ending {
  kEndOfVideo,
  kInterrupted,  ///< Ctrl-C, told to terminate, or its window closed
  kFailed,
};

/// Plays until the video ends, fails, the user stops it, or `seconds` have passed (0: never).
/// Errors and warnings of the pipeline go to standard error, `progress` to standard output: in
/// place on a terminal, else a line now and then. The pipeline is still in PLAYING or PAUSED
/// afterwards.
Ending run_playback(GstElement* pipeline, int seconds,
                    const std::function<std::string()>& progress);
