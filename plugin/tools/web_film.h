// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Films as browsers play them.
#pragma once

#include <string>

#include "plugin/tracks/part_file.h"

namespace spidar::tools {

/// Why some browser does not play the film, as the end of a sentence: "their picture is
/// video/x-h265". Empty when all do: H.264, VP8, VP9 or AV1 with AAC, MP3, Opus or Vorbis, in MP4
/// or WebM. Throws std::runtime_error when it cannot be read.
std::string why_no_browser(const std::string& film);

/// Writes `film` as H.264 and AAC into `part`, whose name ends in .mp4. Returns what is missing in
/// it, as a sentence; usually empty. Throws std::runtime_error.
std::string convert_for_browsers(const std::string& film, const PartFile& part);

}  // namespace spidar::tools
