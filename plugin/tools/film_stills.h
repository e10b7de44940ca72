// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Single pictures of a film, for a drawing.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <gst/gst.h>

#include "plugin/tracks/track_notes.h"

namespace spidar {

/// Pictures of one size, RGB, row by row from the top without gaps.
struct FilmStills {
  int width = 0, height = 0;
  std::vector<std::vector<uint8_t>> rgb;
};

/// `count` pictures, `width` pixels wide, from the middles of as many equal parts of a track of
/// `track_ns` with `notes`. `width` is a multiple of 4. Throws std::runtime_error: the film cannot
/// be played or searched, or the track is that of another one.
FilmStills film_stills(const std::string& film, int64_t track_ns, const TrackNotes& notes,
                       int count, int width);

}  // namespace spidar
