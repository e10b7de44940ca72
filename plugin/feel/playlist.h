// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What is to be played when a folder or a playlist is given.
#pragma once

#include <string>
#include <vector>

namespace spidar {

/// Judges by the extension: M3U, PLS, XSPF, ASX, WPL.
bool is_playlist(const std::string& path);

/// `words` with the films of a folder, and of those below, in its place, sorted by their names as
/// people do ("film 9" before "film 10"); and with what a playlist names in its place: files from
/// its own folder on, folders and other playlists among them. An M3U file of HLS is one film, and
/// stays. Throws std::runtime_error, which says which folder or playlist has no film or cannot be
/// read.
std::vector<std::string> films_of(const std::vector<std::string>& words);

}  // namespace spidar
