// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The command line of `spidartrack record`.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "plugin/tools/film_list.h"
#include "plugin/tools/record_properties.h"

namespace spidar {

struct RecordOptions {
  bool help = false;
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

/// Throws UsageError. The help text has been printed if `help` is set.
RecordOptions parse_record_options(int argc, char** argv);

}  // namespace spidar
