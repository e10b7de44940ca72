// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The metadata of a haptic track: what marks a stream of sound as one, and notes on the film.
#pragma once

#include <optional>
#include <string>

#include <gst/gst.h>

#include "plugin/tracks/film_reader.h"

namespace spidar::tracks {

/// A line of the comment of a track, which FLAC, Matroska and WAV keep, and a tag of its own where
/// there are such. Whatever writes tracks writes it.
extern const char* const kMark;

/// Whether tags of a stream contain the mark. Those of a container apply to all of its streams, and
/// say nothing of one of them.
bool is_marked(const GstTagList* tags);

/// Whether the stream that comes to a pad is marked, from the events that come to it.
class Mark {
 public:
  void follow(GstEvent* event);
  bool is_set() const { return is_set_; }

 private:
  // When the first packets of a network stream are lost, its tags may come before its start, after
  // one that rtpgstdepay has made up. Such a stream has no caps.
  bool has_caps_ = false;
  bool is_set_ = false;
};

/// Whether a tag that has come to `pad` is marked.
bool is_marked(GstPad* pad);

/// Whether sound that nothing has converted, such as that in a file, has the form of the tracks
/// that this project writes: six channels of 1000 samples a second, which no sound for ears has.
bool has_form_of_track(const GstCaps* caps);

/// How to mark a file, as the rest of a sentence.
std::string how_to_mark();

/// Stored in the comment of the track, which FLAC, Matroska and WAV keep. Tracks that were made by
/// hand have neither.
struct Notes {
  FilmFingerprint film;  ///< that it was recorded from; empty: not known
  /// Properties of spidarmotion with which it was recorded, in one line; empty for its defaults.
  std::optional<std::string> settings;
};

/// Title, comment and full scale of a track. Owned by the caller.
GstTagList* tags(const Notes& notes = {});

/// Adds to `notes` what `tags` contain.
void read_notes(const GstTagList* tags, Notes& notes);

/// What `pad`, a linked source pad, sends gets these tags, in place of all others.
void tag(GstPad* pad, const Notes& notes);

}  // namespace spidar::tracks
