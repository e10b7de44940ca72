// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Explains to the user why a film cannot be played.
#pragma once

#include <string>

#include <gst/gst.h>

/// Explains a GST_MESSAGE_ERROR while playing `uri`: GStreamer's text and its reason. If the film
/// is on a machine that cannot be reached, names the machine and the reason, which takes up to five
/// seconds.
std::string failure_text(GstMessage* message, const std::string& uri);

/// Whether a decodebin that was asked for video has found only sound.
bool misses_sound_only(GstMessage* message);

/// Whether this playbin has found its streams and none of them is video.
bool has_no_video(GstElement* playbin);

/// At the end of the stream: a message if the film is shorter than its container says, else empty.
std::string early_end_text(GstElement* pipeline);

constexpr const char* kNoVideo = "there is no video in it";
