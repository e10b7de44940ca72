// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The films that a command line names, by themselves or by their folders.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace spidar {

struct ListedFilm {
  std::string path;
  /// Its folder, relative to the one that was given; empty if the film itself was given.
  std::filesystem::path subfolder;
  uintmax_t bytes = 0;  ///< of the file; 0 if the film itself was given
};

/// The films of `names`. A folder stands for all files in it, and in the folders below, whose names
/// end as those of films do (".mkv" in small or capital letters), without hidden ones and hidden
/// folders: the largest first, so that a long film does not come last and alone. Links to folders
/// are not followed. `left_out` is what the folders have besides films, in one line; may be empty.
/// Throws std::runtime_error if a folder has no film or cannot be read; one below it that cannot is
/// left out.
std::vector<ListedFilm> list_films(const std::vector<std::string>& names, std::string& left_out);

}  // namespace spidar
