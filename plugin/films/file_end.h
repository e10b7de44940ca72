// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Finds whether a file is cut off, and how long its sound is, from its header and its last bytes,
/// without decoding.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace spidar {

enum class FilmEnd {
  kWhole,
  kAppended,  ///< whole, with something appended that is no part of it
  kCutOff,    ///< within a chunk, a segment, a box or a page, or before the last page
  kUnknown,   ///< the file does not state it
};

/// Uses the length that AVI, Matroska, WebM, MP4, QuickTime and Ogg state. The demuxers of
/// GStreamer take a truncated film for a shorter, whole one. Data that cameras and taggers
/// append are no part of the film.
FilmEnd film_end(const std::string& path);

struct FileLength {
  std::optional<int64_t> available_ns;  ///< nothing when unknown without decoding
  int64_t declared_ns = 0;              ///< by its header; 0: not stated
  bool by_samples = false;              ///< both are exact: in WAV and FLAC
  bool is_cut_off = false;              ///< as film_end() finds, or within a frame of FLAC
};

FileLength file_length(const std::string& path);

}  // namespace spidar
