// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What has become of each film of a batch, for programs.
#pragma once

#include <filesystem>
#include <string>

namespace spidar {

/// A film that is done.
struct RecordedFilm {
  std::string film;
  std::filesystem::path track;
  std::string result;  ///< "recorded", "there" or "failed"
  std::string remark;  ///< a warning or, if it failed, the cause; may be empty
  double seconds = 0;  ///< of work
};

/// A line of JSON for the manifest, without the end of the line. Unless the film failed, it has
/// what the track says of itself, which is read for that: duration_s, felt (the share of the time
/// with a force that can be felt), largest_force_N, fingerprint and settings. Throws
/// std::runtime_error.
std::string manifest_line(const RecordedFilm& film);

/// Appends lines to a file, also from several threads and processes.
class ManifestFile {
 public:
  /// Empty: nothing is written. Throws std::runtime_error when the file cannot be opened.
  explicit ManifestFile(const std::string& path);
  ~ManifestFile();
  ManifestFile(const ManifestFile&) = delete;
  ManifestFile& operator=(const ManifestFile&) = delete;

  /// Throws std::runtime_error when the line cannot be written.
  void add(const RecordedFilm& film);

 private:
  const std::string path_;
  int descriptor_ = -1;
};

}  // namespace spidar
