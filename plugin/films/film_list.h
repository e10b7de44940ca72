// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Lists the films that a command line names, directly or by their folders.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace spidar {

struct ListedFilm {
  std::string path;
  /// Its folder, relative to the named one; empty if the film itself was named.
  std::filesystem::path subfolder;
  uintmax_t bytes = 0;  ///< of the file; 0 if the film itself was named
};

/// Returns the films of `names`. A folder stands for the files in it and in the folders below whose
/// names end like those of films (".mkv", ignoring case). Hidden files and folders are left out,
/// and links to folders are not followed. The largest file comes first: a long film that came last
/// would keep only one processor busy. `left_out` describes the other files of the folders, in one
/// line; may be empty. Throws std::runtime_error if a folder has no film or cannot be read; folders
/// below may be unreadable.
std::vector<ListedFilm> list_films(const std::vector<std::string>& names, std::string& left_out);

}  // namespace spidar
