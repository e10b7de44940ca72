// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tools/film_list.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <iterator>
#include <stdexcept>

namespace spidar {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFilmEnds[] = {".3gp", ".avi", ".flv",  ".m2ts", ".m4v", ".mkv",
                                     ".mov", ".mp4", ".mpeg", ".mpg",  ".mts", ".mxf",
                                     ".ogv", ".ts",  ".vob",  ".webm", ".wmv"};

bool has_film_name(const fs::path& path) {
  if (path.filename().string().front() == '.') return false;
  std::string end = path.extension().string();
  std::transform(end.begin(), end.end(), end.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::find(std::begin(kFilmEnds), std::end(kFilmEnds), end) != std::end(kFilmEnds);
}

struct FoundFilm {
  ListedFilm film;
  uintmax_t bytes = 0;
};

std::vector<FoundFilm> films_below(const std::string& folder) {
  std::vector<FoundFilm> found;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    std::error_code gone;  // it may be renamed or removed in the meantime
    if (!entry.is_regular_file(gone) || !has_film_name(entry.path())) continue;
    const uintmax_t bytes = entry.file_size(gone);
    if (gone) continue;
    const fs::path subfolder = entry.path().lexically_relative(folder).parent_path();
    found.push_back({{entry.path().string(), subfolder}, bytes});
  }
  std::sort(found.begin(), found.end(), [](const FoundFilm& a, const FoundFilm& b) {
    return a.bytes != b.bytes ? a.bytes > b.bytes : a.film.path < b.film.path;
  });
  return found;
}

}  // namespace

std::vector<ListedFilm> list_films(const std::vector<std::string>& names) {
  std::vector<ListedFilm> films;
  for (const std::string& name : names) {
    if (!fs::is_directory(name)) {
      films.push_back({name, {}});
      continue;
    }
    try {
      const std::vector<FoundFilm> found = films_below(name);
      if (found.empty()) {
        throw std::runtime_error(name +
                                 ": this folder has no film (names that end in .mkv, .mp4 …)");
      }
      for (const FoundFilm& one : found) films.push_back(one.film);
    } catch (const fs::filesystem_error& error) {
      throw std::runtime_error(error.path1().string() +
                               ": cannot be read: " + error.code().message());
    }
  }
  return films;
}

}  // namespace spidar
