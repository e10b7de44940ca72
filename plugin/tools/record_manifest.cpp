// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tools/record_manifest.h"

#include <cerrno>
#include <fcntl.h>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <unistd.h>
#include <vector>

#include "plugin/tools/track_samples.h"
#include "plugin/tools/track_summary.h"
#include "spidar/realtime/standard_descriptors.h"

namespace spidar {
namespace {

[[noreturn]] void fail(const std::string& path) {
  throw std::runtime_error("the manifest " + path + " cannot be written: " + output_reason(errno));
}

}  // namespace

std::string manifest_line(const RecordedFilm& film) {
  nlohmann::ordered_json line = {{"film", film.film},
                                 {"result", film.result},
                                 {"seconds", film.seconds},
                                 {"version", SPIDAR_VERSION}};
  if (!film.remark.empty()) line[film.result == "failed" ? "error" : "warning"] = film.remark;
  if (film.result != "failed") {
    TrackCondition condition;
    const std::vector<TrackSample> samples = load_track(film.track.string(), &condition);
    line["track"] = film.track.string();
    line["duration_s"] = static_cast<double>(samples.size()) / kTrackRate_Hz;
    const TrackSummary summary = summarise(samples);
    line["felt"] = summary.felt;
    line["largest_force_N"] = summary.largest_force_N;
    line["fingerprint"] = to_text(condition.notes.film);
    line["settings"] = condition.notes.settings.value_or("");
  }
  // File names are bytes, and JSON is UTF-8.
  return line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

ManifestFile::ManifestFile(const std::string& path) : path_(path) {
  if (path.empty()) return;
  descriptor_ = open_output(path.c_str(), O_APPEND);
  if (descriptor_ < 0) fail(path);
}

ManifestFile::~ManifestFile() {
  if (descriptor_ >= 0) close(descriptor_);
}

void ManifestFile::add(const RecordedFilm& film) {
  if (descriptor_ < 0) return;
  const std::string line = manifest_line(film) + "\n";
  // In one call, so that lines of several writers do not mix.
  const ssize_t written = write(descriptor_, line.data(), line.size());
  if (written >= 0 && static_cast<size_t>(written) < line.size()) errno = ENOSPC;
  if (written < 0 || static_cast<size_t>(written) < line.size()) fail(path_);
}

}  // namespace spidar
