// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A haptic track from the trace of spidarmotion, which has one line for each frame.
#pragma once

#include <string>
#include <vector>

#include "core/track/track_format.h"

namespace spidar {

/// What spidarextract would have given for these frames. `path` is for messages, `text` what is in
/// the file. Both throw std::runtime_error that names the line which cannot be read.
std::vector<TrackSample> read_csv_trace(const std::string& path, const std::string& text);
/// The same of JSON lines; frames that repeat a picture, and those after a cut, are told apart.
std::vector<TrackSample> read_json_trace(const std::string& path, const std::string& text);

}  // namespace spidar
