// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The options of `spidartrack record`.
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

/// The properties with the rules of `feel` themselves in place of the file that has them, beside
/// `film` or elsewhere, so that a track states what it was made with. Throws std::runtime_error
/// when they cannot be read.
RecordProperties with_rules(const RecordProperties& properties, const std::string& film);

/// `words` are of the form PROPERTY=VALUE, or preset=NAME. Throws UsageError, which says what would
/// be right, for those that do not change what a track contains, or would make it one of zeros;
/// std::runtime_error when GStreamer has no spidarmotion.
RecordProperties parse_record_properties(const std::vector<std::string>& words, size_t films);

/// The properties that the settings of a track state. Throws std::runtime_error as
/// parse_record_properties() does.
RecordProperties properties_of(const std::string& settings);

/// Throws UsageError with the line to type in place of one that names the track of `film`.
[[noreturn]] void refuse_output(const std::string& film, const std::string& output);

/// Throws UsageError for what looks like a property where a film is expected: `command` is what
/// comes before the dashes.
void expect_no_property(const std::string& film, const std::string& command);

struct RecordOptions {
  bool force = false;
  unsigned jobs = 1;
  std::string folder;
  std::string format = "flac";
  RecordProperties properties;
  std::string manifest;  ///< a file; empty: none
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
