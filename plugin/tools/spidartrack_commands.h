// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The commands of spidartrack. They return the exit status, and throw UsageError and
/// std::runtime_error.
#pragma once

#include <optional>
#include <string>

#include "plugin/tools/record_options.h"
#include "plugin/tools/track_samples.h"

namespace spidar {

struct InfoOptions {
  std::string path;  ///< of a track or a film
  bool json = false;
};

/// The limits are those of spidarsink by default.
struct CheckOptions {
  std::string track;
  double max_force_N = 3, max_torque_Nm = 0.1;
};

struct ConvertOptions {
  std::string from, to;
  std::string axis;            ///< the channel by its name; empty: the usual one
  std::optional<double> gain;  ///< empty: that which fills the range of `to`
  SaveOptions save;
};

struct PlotOptions {
  std::string track, png;
};

struct ShowOptions {
  std::string film, to;
  RecordProperties properties;
};

struct ExportOptions {
  std::string film, to;
};

int record_films(const RecordOptions& options);
int print_info(const InfoOptions& options);
int check_track(const CheckOptions& options);
int convert_track(const ConvertOptions& options);
int plot_track(const PlotOptions& options);
int show_film(const ShowOptions& options);
int export_film(const ExportOptions& options);

}  // namespace spidar
