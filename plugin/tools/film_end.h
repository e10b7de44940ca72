// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Whether a file is as long as it says.
#pragma once

#include <string>

namespace spidar {

enum class FilmEnd {
  kWhole,
  kCutOff,   ///< within a chunk, a segment, a box or a page, or before the last page
  kUnknown,  ///< the file does not say
};

/// By what AVI, Matroska, WebM, MP4, QuickTime and Ogg say of their length. The demuxers of
/// GStreamer take such a film that is cut off for a shorter one that is whole.
FilmEnd film_end(const std::string& path);

}  // namespace spidar
