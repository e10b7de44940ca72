// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tools/record_options.h"

#include "spidar/tools/command_line.h"

namespace spidar {

namespace fs = std::filesystem;

fs::path RecordOptions::file_of(const ListedFilm& film) const {
  const fs::path file = film.path + ".haptic." + format;
  return folder.empty() ? file : fs::path(folder) / film.subfolder / file.filename();
}

void set_films(RecordOptions& options, const std::vector<std::string>& names,
               const std::vector<std::string>& properties) {
  for (const std::string& film : names) {
    if (film.find('=') == std::string::npos || fs::exists(film)) continue;
    throw UsageError(
        film + ": there is no such film; properties follow --: spidartrack record FILM -- " + film);
  }
  options.films = list_films(names);
  options.properties = parse_record_properties(properties, options.films.size());
}

}  // namespace spidar
