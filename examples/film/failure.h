// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Why a film cannot be played, in words for who wants to see it.
#pragma once

#include <string>

#include <gst/gst.h>

/// Of a GST_MESSAGE_ERROR while playing `uri`: what GStreamer says and its reason. Where the film
/// is on another machine that cannot be reached, which one and why; that takes up to five seconds.
std::string failure_text(GstMessage* message, const std::string& uri);

/// Whether a decodebin that was asked for video has found nothing but sound.
bool misses_sound_only(GstMessage* message);

/// Whether this playbin has found its streams and none of them is video.
bool has_no_video(GstElement* playbin);

/// For the end of the stream: empty, or that the film is shorter than it says.
std::string early_end_text(GstElement* pipeline);

constexpr const char* kNoVideo = "there is no video in it";
