// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Decodes a film, optionally with an element after the decoder.
#pragma once

#include <string>
#include <vector>

#include "tests/support/picture.h"

namespace spidar::bench {

/// A GStreamer element that decoding() needs and that is not installed; empty: none.
std::string missing_for_decoding();

/// Writes `frames` to an H.264 file. Throws std::runtime_error as Pipeline does.
void encode(const std::vector<test::Picture>& frames, int rate_Hz, const std::string& file);

/// Milliseconds of processor time a frame of all threads, whoever else uses the machine, for
/// playing `file` of so many frames through avdec_h264 in one thread and `filter`. Throws as
/// encode() does.
double decoding_ms(const std::string& file, int frames, const std::string& filter);

}  // namespace spidar::bench
