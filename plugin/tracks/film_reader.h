// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Reads from a film, without decoding it, what its haptic track is compared with.
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "plugin/tracks/film_fingerprint.h"

namespace spidar {

struct Film {
  std::vector<FilmPacket> packets;  ///< at its beginning, in the order of the stream
  int64_t begin_ns = 0;             ///< stream time of the first picture
  /// Stream time of the end of the last picture. Nothing when it cannot be found without reading
  /// the whole of a long film.
  std::optional<int64_t> end_ns;
  int64_t duration_ns = 0;  ///< of the longest stream; 0 when the container does not say
  int64_t frame_ns = 0;     ///< longest time between two pictures at the beginning
  bool has_track = false;   ///< a haptic track is inside the film
};

/// Reads the beginning and the end of the first video stream of `path`: some megabytes, a short
/// film completely. Throws std::runtime_error, which says what is wrong, when it has no pictures or
/// cannot be read, or when `stopped` has become true.
Film read_film(const std::string& path, const std::atomic<bool>* stopped = nullptr);

}  // namespace spidar
