// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The metadata of a haptic track: what marks it as one, and notes on the film.
#pragma once

#include <optional>
#include <string>

#include <gst/gst.h>

#include "plugin/films/film_reader.h"

namespace spidar::tracks {

/// Notes on the film, in the comment of the track, which FLAC, Matroska and WAV keep. Handmade
/// tracks have no notes.
struct Notes {
  FilmFingerprint film;  ///< the source of the track; empty: unknown
  /// The properties of spidarmotion for the recording, in one line; empty for the defaults.
  std::optional<std::string> settings;
  /// The original format of a converted track, whose length may differ from the film; empty: none.
  std::string origin = {};
};

/// Title, comment and full scale of a track. Owned by the caller.
GstTagList* tags(const Notes& notes = {});

void read_notes(const GstTagList* tags, Notes& notes);

/// Makes `pad`, a linked source pad, send these tags in place of all others.
void tag(GstPad* pad, const Notes& notes);

}  // namespace spidar::tracks
