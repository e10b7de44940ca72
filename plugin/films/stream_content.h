// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The content of a stream of a film: pictures, audible sound, or a haptic track.
#pragma once

#include <string>

#include <gst/gst.h>

namespace spidar {

/// The mark of a track: a line of its comment, which FLAC, Matroska and WAV keep, and a tag of its
/// own in other formats. Every writer of tracks writes it.
extern const char* const kTrackMark;

/// Whether tags of a stream contain the mark. Those of a container apply to all of its streams, and
/// say nothing about a single one.
bool is_marked_track(const GstTagList* tags);

/// Finds from the events of a stream whether it is marked as a track.
class TrackMark {
 public:
  void update(GstEvent* event);
  bool is_set() const { return is_set_; }

 private:
  // When the first packets of a network stream are lost, its tags may come after a STREAM_START
  // that rtpgstdepay has made up, and before the real one. The made-up stream has no caps.
  bool has_caps_ = false;
  bool is_set_ = false;
};

/// Whether a tag that `pad` has received contains the mark.
bool is_marked_track(GstPad* pad);

/// Whether sound without conversion, such as that in a file, has the form of the tracks that this
/// project writes: six channels of 1000 samples a second, which no audible sound has.
bool has_form_of_track(const GstCaps* caps);

std::string how_to_mark();

enum class StreamContent {
  kVideo,
  kSound,        ///< audible
  kHapticTrack,  ///< has_form_of_track(), or is_marked_track()
  kSubtitles,    ///< text or pictures
  kOther,
};

/// The content of a parsed or decoded stream with these caps.
StreamContent content_of(const GstCaps* caps);
/// The content of the stream at a pad, by its caps and by the tags that have come to it.
StreamContent content_of(GstPad* pad);

/// Whether a stream consists of pictures in a format of still images, as a cover: image/jpeg.
bool is_picture(const GstCaps* caps);

/// Why no pictures, or no sound, come from the demuxers in `bin`, as the rest of a sentence; empty
/// unless there is a known reason.
std::string why_missing(GstElement* bin);

/// Stream time of a buffer that passes the pad; GST_CLOCK_TIME_NONE when it has none.
GstClockTime stream_time_of(GstPad* pad, GstBuffer* buffer);

/// The current caps of a pad, else its possible ones. Owned by the caller.
GstCaps* caps_of(GstPad* pad);

}  // namespace spidar
