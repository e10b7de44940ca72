// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A haptic track in a file, and what it says of itself in its metadata.
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <gst/gst.h>

#include "core/track/track_format.h"
#include "plugin/tracks/film_reader.h"
#include "plugin/tracks/track_input.h"

namespace spidar {

/// Stored in the comment of the track, which FLAC, Matroska and WAV keep. Tracks that were made by
/// hand have neither.
struct TrackNotes {
  FilmFingerprint film;  ///< that it was recorded from; empty: not known
  /// Properties of spidarmotion with which it was recorded, in one line; empty for its defaults.
  std::optional<std::string> settings;
};

/// Title, comment and full scale of a track. Owned by the caller.
GstTagList* track_tags(const TrackNotes& notes = {});

/// Adds to `notes` what `tags` contain.
void read_notes(const GstTagList* tags, TrackNotes& notes);

/// What `pad`, a linked source pad, sends gets these tags, in place of all others.
void tag_track(GstPad* pad, const TrackNotes& notes);

/// A whole track. The times of its blocks are those of the file, and rise.
struct TrackFile {
  /// A longer one, of which a single wild timestamp is enough, would take all memory.
  static constexpr int64_t kLongest_ns = 24 * 3600 * int64_t{1'000'000'000};

  std::vector<TrackBlock> blocks;
  int64_t duration_ns = 0;
  /// As long as the file says that it is; shorter than that it is cut off. 0: it does not say.
  int64_t promised_ns = 0;
  TrackFaults faults;
  TrackNotes notes;

  /// Empty, or what is missing at the end of the file.
  std::string missing() const;
};

/// Reads the haptic track of a file, else its first sound, from any container that GStreamer has a
/// decoder for, into memory: 90 MB an hour. Throws std::runtime_error, which says what was wrong,
/// when there is none, when it is no haptic track (TrackInput::set_caps()), when the file is
/// damaged or not a regular one, when the track is longer than kLongest_ns, or when `stopped` has
/// become true.
TrackFile read_track_file(const std::string& path, const std::atomic<bool>* stopped = nullptr);

/// Only what such a track says of itself, from the beginning of the file. Empty where there is
/// none.
TrackNotes read_track_notes(const std::string& path);

}  // namespace spidar
