// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Decodes a film, optionally with an element after the decoder.
#pragma once

#include <string>
#include <vector>

#include "tests/support/picture.h"

namespace spidar::bench {

/// The GStreamer element that encode() takes; empty: none is installed.
std::string h264_encoder();
/// What to install when there is none.
constexpr const char* kNoEncoder =
    "neither x264enc (gstreamer1.0-plugins-ugly) nor openh264enc (gstreamer1.0-plugins-bad) is "
    "installed";

bool is_installed(const std::string& element);

/// Why decoding_ms() cannot be measured here; empty when it can.
std::string missing_for_decoding();

/// Writes a film of `count` frames, which are those of `film` to and fro: H.264 in MP4, or by
/// `encoding`, which is between `!` in a launch line and ends in a muxer. Throws std::runtime_error
/// as Pipeline does.
void encode(const std::vector<test::Picture>& film, int count, int rate_Hz, const std::string& file,
            const std::string& encoding = {});

/// Milliseconds of processor time a frame of all threads, whoever else uses the machine, for
/// playing `file` of so many frames through avdec_h264 in one thread and `filter`. Throws as
/// encode() does.
double decoding_ms(const std::string& file, int frames, const std::string& filter);

}  // namespace spidar::bench
