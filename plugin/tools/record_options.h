// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What `spidartrack record` is to do.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "plugin/tools/film_list.h"
#include "plugin/tools/record_properties.h"

namespace spidar {

struct RecordOptions {
  bool force = false;
  unsigned jobs = 1;
  std::string folder;
  std::string format = "flac";
  RecordProperties properties;
  std::string manifest;  ///< a file; empty: none
  std::vector<ListedFilm> films;

  /// The file of a film's track.
  std::filesystem::path file_of(const ListedFilm& film) const;
};

/// Fills in films, and properties of the form PROPERTY=VALUE. `names` are of films and folders.
/// Throws UsageError.
void set_films(RecordOptions& options, const std::vector<std::string>& names,
               const std::vector<std::string>& properties);

}  // namespace spidar
