// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The metadata of a haptic track: what marks it as one, and notes on the film.
#pragma once

#include <optional>
#include <string>

#include <gst/gst.h>

#include "plugin/films/film_reader.h"

namespace spidar::tracks {

/// Stored in the comment of the track, which FLAC, Matroska and WAV keep. Tracks that were made by
/// hand have no notes.
struct Notes {
  FilmFingerprint film;  ///< that it was recorded from; empty: not known
  /// Properties of spidarmotion with which it was recorded, in one line; empty for its defaults.
  std::optional<std::string> settings;
  /// The format that the track was converted from, whose length says nothing of the film; empty:
  /// none.
  std::string origin = {};
};

/// Title, comment and full scale of a track. Owned by the caller.
GstTagList* tags(const Notes& notes = {});

/// Adds to `notes` what `tags` contain.
void read_notes(const GstTagList* tags, Notes& notes);

/// Makes `pad`, a linked source pad, send these tags in place of all others.
void tag(GstPad* pad, const Notes& notes);

}  // namespace spidar::tracks
