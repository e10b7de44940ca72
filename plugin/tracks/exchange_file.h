// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Exchange formats, funscripts and HJIF, that are felt with a film without converting them.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/track/track_format.h"
#include "plugin/tracks/open_track.h"

namespace spidar::tracks {

/// Judges by the extension, ignoring case.
bool is_exchange_file(const std::string& path);

/// Searches beside a film for a script (find_script()), else for FILM.hjif, with or without the
/// extension of the film. Empty when there is none.
std::string find_exchange_file(const std::string& film);

/// Opens an exchange file; a script with its set, as read_scripts() does. Throws
/// std::runtime_error, which names the file and what in it is wrong or cannot be felt.
std::unique_ptr<OpenTrack> open_exchange_file(const std::string& path, const std::string& film);

/// Reads 1000 samples a second as read_hjif() does, and appends what that leaves out, with the
/// path, to `unfelt`. Throws as open_exchange_file() does.
std::vector<TrackSample> read_hjif_file(const std::string& path, std::vector<std::string>& unfelt);

}  // namespace spidar::tracks
