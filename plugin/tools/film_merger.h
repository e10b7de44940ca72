// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Merges a haptic track into a film.
#pragma once

#include <string>

#include "plugin/track/track_notes.h"

namespace spidar {

/// Copies the streams of `film` without decoding them, together with the sound of the file `track`,
/// which says `notes` of itself, into the Matroska file `out`. Returns what of the film is lost, in
/// sentences; usually nothing. Throws std::runtime_error, whose message says what would be right,
/// when the film has no sound, has a haptic track already, or has a stream that Matroska does not
/// accept. `out` is then incomplete.
std::string merge_film(const std::string& film, const std::string& track, const TrackNotes& notes,
                       const std::string& out);

}  // namespace spidar
