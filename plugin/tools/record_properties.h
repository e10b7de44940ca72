// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The properties of spidarmotion that a track can be recorded with.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace spidar {

struct RecordProperties {
  /// Names and values, for gst_util_set_object_arg().
  std::vector<std::pair<std::string, std::string>> values;
  /// Those that differ from their defaults, by name, in one form for every way to type them:
  /// "max-force=2 motion=camera". Empty when all have their defaults.
  std::string settings;
};

/// With the rules of `feel` themselves in place of the file, beside `film` or elsewhere, that has
/// them, so that a track tells what it was made by. Throws std::runtime_error when they cannot be
/// read.
RecordProperties with_rules(const RecordProperties& properties, const std::string& film);

/// `words` are of the form PROPERTY=VALUE. Throws UsageError, which says what would be right, for
/// those that do not change what a track contains, or would make it one of zeros;
/// std::runtime_error when GStreamer has no spidarmotion.
RecordProperties parse_record_properties(const std::vector<std::string>& words, size_t films);

}  // namespace spidar
