// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The funscripts of a film: one for each axis, or several axes in one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/track/funscript.h"
#include "core/track/track_format.h"

namespace spidar::tracks {

/// Judges by the extension, ignoring case.
bool is_script(const std::string& path);

/// Finds a script beside a film, whose set is to be read: FILM.funscript, FILM.roll.funscript and
/// so on, with or without the extension of the film; that of the main axis if there is one. Empty
/// when there is none.
std::string find_script(const std::string& film);

struct ScriptChoice {
  std::optional<size_t> channel;  ///< only the actions of the file itself, as this channel
  std::optional<double> gain;     ///< the gain of all files; nothing: each file states its own
  std::string film;               ///< whose set is read; empty: the film in the script's name
};

struct ScriptSet {
  std::vector<ScriptAxis> axes;    ///< one for each channel
  std::vector<std::string> about;  ///< a line on each axis, with its file
  std::vector<std::string>
      unfelt;  ///< parts that are not read: "film.vib.funscript", "vib of film.funscript"

  /// One more than the last millisecond that has a position.
  int64_t length_ms() const;
  TrackSample at(int64_t time_ms) const;
};

/// Reads a script, and the others of its set if its own name has no axis. Throws
/// std::runtime_error, which names the file, when one is wrong, or when no axis has any position.
ScriptSet read_scripts(const std::string& path, const ScriptChoice& choice = {});

}  // namespace spidar::tracks
