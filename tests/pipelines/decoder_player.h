// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A player of the kind that GStreamer's tutorials begin with: a decoder, whose video is linked to
/// a sink when its pad appears.
#pragma once

#include <string>

#include <gst/gst.h>

namespace spidar::test {

/// A pipeline whose `decoder` is decodebin, decodebin3, uridecodebin or uridecodebin3. It shows its
/// video in a fakevideosink, in which `window` is the fakesink.
GstElement* make_decoder_player(const std::string& decoder, const std::string& film,
                                GstElement** window);

/// Puts a spidarmotion of the player's own, without a device, before its sink.
void add_own_motion(GstElement* player);

/// From now on the sink refuses all caps when it is asked, but takes the frames that come.
void refuse_caps(GstElement* player);

/// From now on the player takes 200 ms for each new pad of the decoder. Meanwhile the decoder has a
/// frame.
void take_time_with_pads(GstElement* player);

}  // namespace spidar::test
