// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Converts a trace of spidarmotion, which has one line for each frame, to a haptic track.
#pragma once

#include <string>
#include <vector>

#include "core/track/track_format.h"

namespace spidar {

/// The samples that spidarextract would have given for these frames. `path` is used in messages,
/// `text` is the content of the file. Both functions throw std::runtime_error that names the line
/// which cannot be read.
std::vector<TrackSample> read_csv_trace(const std::string& path, const std::string& text);
/// The same for JSON lines, which also tell frames that repeat a picture, and frames after a cut.
std::vector<TrackSample> read_json_trace(const std::string& path, const std::string& text);

}  // namespace spidar
