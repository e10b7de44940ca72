// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Reads each film in a process of its own, so that a crash of a demuxer or decoder costs one film.
#pragma once

#include <functional>
#include <string>

#include "core/json_text.h"
#include "plugin/tools/record_options.h"
#include "spidar/part_file.h"

namespace spidar::tools {

struct FilmJob {
  std::string film;
  std::string track;
  /// The properties for the recording of the track; `feel` has rules, not their file.
  RecordProperties properties;
  bool is_summarised = false;  ///< whether the result has a summary
};

struct FilmResult {
  std::string felt;    ///< how much of the film is felt, and why the rest is not
  std::string remark;  ///< for the user; usually empty
  std::string other;   ///< why the existing track is not the one that would be recorded; or empty
  bool is_by_others =
      false;     ///< the existing track can be read, and does not say that it was recorded
  Json summary;  ///< of the track, an object; empty without is_summarised
};

/// Records the film of `job` into `part`. `report` is called with the percentage of the work,
/// whenever it rises. Throws std::runtime_error with the reason, or with how the process ended.
FilmResult record_in_process(const FilmJob& job, const PartFile& part,
                             const std::function<void(int percent)>& report);

/// Compares the existing track with the one that would be recorded. A track without notes was made
/// by hand or by an older version, and counts as the same. Throws std::runtime_error when the film
/// cannot be read, or the process fails.
FilmResult check_in_process(const FilmJob& job);

/// The main function of such a process; returns −1 when the arguments are those of a user. Call
/// this before gst_init().
int run_film_process(int argc, char** argv);

}  // namespace spidar::tools
