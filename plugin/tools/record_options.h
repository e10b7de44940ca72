// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The command line of `spidartrack record` and `analyze`.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/analysis/motion_file.h"
#include "plugin/tools/film_list.h"
#include "plugin/tools/record_properties.h"

namespace spidar {

struct RecordOptions {
  Purpose purpose = Purpose::kRecord;
  bool help = false;
  bool force = false;
  unsigned jobs = 1;
  std::string folder;
  std::string format = "flac";
  RecordProperties properties;
  std::string manifest;  ///< a file; empty: none
  MotionPiece piece;     ///< what is measured of each film; of 0: all
  std::vector<ListedFilm> films;

  /// Whether a track is recorded, not something measured.
  bool makes_tracks() const { return purpose == Purpose::kRecord && piece.of == 0; }
  /// The file of a film's track or analysis.
  std::filesystem::path file_of(const ListedFilm& film) const;
};

/// Throws UsageError. The help text has been printed if `help` is set.
RecordOptions parse_record_options(int argc, char** argv, Purpose purpose);

}  // namespace spidar
