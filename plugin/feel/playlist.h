// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <string>
#include <vector>

namespace spidar {

/// Judges by the extension: M3U, PLS, XSPF, ASX, WPL.
bool is_playlist(const std::string& path);

/// Replaces folders and playlists in `words` by their films. A folder stands for its films and
/// those below, sorted by name as people do ("film 9" before "film 10"). The names in a playlist
/// are relative to its own folder, and may be folders and other playlists. An M3U file of HLS is
/// one film and is kept. Throws std::runtime_error, which says which folder or playlist has no film
/// or cannot be read.
std::vector<std::string> films_of(const std::vector<std::string>& words);

}  // namespace spidar
