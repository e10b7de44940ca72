// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Runs a film through spidarmotion, as fast as it can be decoded.
#pragma once

#include <functional>
#include <string>

#include <gst/gst.h>

#include "plugin/tools/record_properties.h"
#include "plugin/tracks/film_fingerprint.h"

namespace spidar {

struct FilmRun {
  std::string film;
  const RecordProperties& properties;
  std::string rest;  ///< of the launch line, behind spidarmotion
  /// Called before the film is decoded; the element is "motion".
  std::function<void(GstElement* pipeline, const FilmFingerprint& film)> prepare;
  /// Called in another thread with the percentage that is done, whenever it rises.
  std::function<void(int percent)> tell;
};

struct FilmOutcome {
  std::string felt;    ///< how much of the film is felt, and why the rest is not
  std::string remark;  ///< what else is to be known of it; usually empty
};

/// Throws std::runtime_error, which says what is wrong with the film.
FilmOutcome decode_film(const FilmRun& run);

}  // namespace spidar
