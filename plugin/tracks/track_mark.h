// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What marks a stream of sound as a haptic track.
#pragma once

#include <string>

#include <gst/gst.h>

namespace spidar {

/// A line of the comment of a track, which FLAC, Matroska and WAV keep, and a tag of its own where
/// there are such. Whatever writes tracks writes it.
extern const char* const kTrackMark;

/// Whether tags of a stream contain the mark. Those of a container apply to all of its streams, and
/// say nothing of one of them.
bool is_marked(const GstTagList* tags);

/// Whether the stream that comes to a pad is marked, from the events that come to it.
class StreamMark {
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

}  // namespace spidar
