// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "plugin/films/film_list.h"

namespace spidar::tools {

struct RecordProperties {
  /// Names and values, for gst_util_set_object_arg().
  std::vector<std::pair<std::string, std::string>> values;
  /// The properties that differ from their defaults, by name, in one form for every way to type
  /// them: "max-force=2 motion=camera". Empty when all have their defaults.
  std::string settings;
};

/// Replaces the file of `feel`, beside `film` or elsewhere, by its rules, so that a track states
/// how it was made. Throws std::runtime_error when the file cannot be read.
RecordProperties with_rules(const RecordProperties& properties, const std::string& film);

/// `words` are of the form PROPERTY=VALUE, or preset=NAME. Throws UsageError, which says what would
/// be right, for properties that do not change a track, or would make it one of zeros;
/// std::runtime_error when GStreamer has no spidarmotion.
RecordProperties parse_record_properties(const std::vector<std::string>& words, size_t films);

/// Parses the settings that a track states. Throws as parse_record_properties() does.
RecordProperties properties_of(const std::string& settings);

/// Throws UsageError with the right command line: `output` is the track of `film`, not a film.
[[noreturn]] void refuse_output(const std::string& film, const std::string& output);

/// Throws UsageError if `film` is a property; `command` is the text before the dashes.
void expect_no_property(const std::string& film, const std::string& command);

struct RecordOptions {
  bool force = false;
  unsigned jobs = 1;
  std::string folder;
  std::string format = "flac";
  RecordProperties properties;
  std::string manifest;  ///< the file; empty: none
  std::vector<ListedFilm> films;
  std::string left_out;  ///< of list_films()

  /// The file of a film's track.
  std::filesystem::path file_of(const ListedFilm& film) const;
};

/// Fills in films, and properties of the form PROPERTY=VALUE. `names` are of films and folders.
/// Throws UsageError.
void set_films(RecordOptions& options, const std::vector<std::string>& names,
               const std::vector<std::string>& properties);

}  // namespace spidar::tools
