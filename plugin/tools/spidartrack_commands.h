// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The commands of spidartrack. They return the exit status, and throw UsageError and
/// std::runtime_error.
#pragma once

#include <iostream>
#include <optional>
#include <string>

#include "plugin/tools/record_options.h"
#include "plugin/tools/track_samples.h"
#include "spidar/part_file.h"

namespace spidar::tools {

/// ConvertOptions::axis of six funscripts.
constexpr const char* kAllAxes = "all";

struct ConvertOptions {
  std::string from, to;
  bool force = false;          ///< here and below: PartFile::Replaces::any
  std::string axis;            ///< the channel by its name; empty: the usual one
  std::optional<double> gain;  ///< empty: fills the range of `to`
  SaveOptions save;
};

struct ExportOptions {
  std::string film, to;
  std::string track;                           ///< empty: that of the film, else it is recorded
  std::optional<RecordProperties> properties;  ///< with which it is recorded in any case
  bool force = false;
  bool embed = false;  ///< puts the film into the page
};

/// Publishes a part file, and prints the remark of PartFile::publish().
inline void publish(PartFile& part) {
  const std::string more = part.publish();
  if (!more.empty()) std::cerr << part.target() << ": " << more << '\n';
}

int record_films(const RecordOptions& options);
int print_info(const std::string& track_or_film, bool as_json);
int check_track(const std::string& track, double max_force_N, double max_torque_Nm);
int convert_track(const ConvertOptions& options);
/// For `force` see PartFile::Replaces::any.
int plot_track(const std::string& track, const std::string& png, bool force);
int show_film(const std::string& film, const std::string& to, bool force, bool draws_subtitles,
              const RecordProperties& properties);
int export_film(const ExportOptions& options);

}  // namespace spidar::tools
