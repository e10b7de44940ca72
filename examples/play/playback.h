// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <functional>
#include <string>

#include <gst/gst.h>

enum class Ending {
  kEndOfVideo,
  kInterrupted,  ///< by Ctrl-C, a signal to terminate, or the closed window
  kFailed,
};

struct PlaybackWatch {
  /// A line that is shown in place on a terminal, otherwise from time to time.
  std::function<std::string()> progress;
  /// Whether the user has not closed the window of the video.
  std::function<bool()> is_wanted;
  /// Called with each message `spidar-motion`.
  std::function<void(const GstStructure*)> on_motion;
  /// Called with each message `spidar-device`.
  std::function<void(const GstStructure*)> on_device;
  /// Called fifty times a second while the video plays, with its running time.
  std::function<void(double time_s)> on_moment;
};

/// Plays until the video ends, reaches the second `seconds` (0: none) or fails, or the user stops
/// it. Prints errors and warnings of the pipeline on standard error and the progress on standard
/// output. Afterwards the pipeline is still in PLAYING or PAUSED. `film` is its name for messages.
Ending run_playback(GstElement* pipeline, const std::string& film, int seconds,
                    const PlaybackWatch& watch);

/// Executes a message GST_MESSAGE_REQUEST_STATE, by which the debug window pauses and plays.
void set_requested_state(GstElement* pipeline, GstMessage* message);
