// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Files that belong to a film: its haptic track, and the rules of what is felt.
#pragma once

#include <initializer_list>
#include <string>

#include <gst/gst.h>

#include "plugin/films/film_reader.h"
#include "plugin/tracks/track_tags.h"

namespace spidar {

/// The path of FILM with one of the suffixes `ends`, else the same without the extension of FILM:
/// the first file that exists; empty when none does. The whole name comes first because films may
/// differ only in their extensions.
std::string find_beside(const std::string& film, std::initializer_list<const char*> ends);

/// The path of the film that comes to `pad` (GST_QUERY_URI upstream); empty when it is not a file.
std::string film_of(GstPad* pad);

/// The environment variable that lists folders of tracks that do not lie beside their films,
/// separated by colons.
extern const char* const kTrackPathVariable;

/// Returns `.haptic.flac`, `.haptic.mka` or `.haptic.wav` beside the film, see find_beside(); else
/// in the folders of kTrackPathVariable, else in that of the user,
/// ~/.local/share/gst-spidar/tracks: in the subfolder of the film, if it has one. Empty if none.
std::string find_sidecar(const std::string& film);

/// Returns a sentence if find_sidecar() finds another track than `track`, or ignores tracks beside
/// the film in favour of `track`; otherwise an empty string.
std::string why_not_played(const std::string& film, const std::string& track);

/// FilmMatch::mismatch of a track that was made of other pictures than the film has.
extern const char* const kOtherPictures;

struct FilmMatch {
  std::string mismatch;  ///< empty, or why the track is not that of the film
  int64_t later_ns = 0;  ///< how much later than the track says the film shows its pictures
};

/// Compares `film` with a track of `track_ns` that has `notes`. A track with a fingerprint is
/// recognised by that picture, which may come later in another container; any other track by its
/// length: it ends with the last picture, within one frame. A track that was converted from another
/// format may end anywhere.
FilmMatch match_film(const Film& film, int64_t track_ns, const tracks::Notes& notes);

/// For a film that is not a file: the duration of the film that comes to `pad`, if known, must
/// agree with `track_ns`, that of the track, within a frame. Returns an empty string, or why the
/// track is that of another film.
std::string why_other_film(GstPad* pad, int64_t track_ns, int64_t frame_ns);

}  // namespace spidar
