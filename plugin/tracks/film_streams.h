// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What kind of stream it is that a film has.
#pragma once

#include <string>

#include <gst/gst.h>

namespace spidar {

enum class StreamKind {
  kVideo,
  kSound,        ///< for ears
  kHapticTrack,  ///< six channels, at a rate that no sound has
  kOther,
};

/// Of the caps of a parsed or decoded stream.
StreamKind kind_of(const GstCaps* caps);

/// Why no pictures, or no sound, come from the demuxers in `bin`, as the rest of a sentence; empty
/// unless there is a known reason.
std::string why_missing(GstElement* bin);

/// Current caps, else what the pad could have. Owned by the caller.
GstCaps* caps_of(GstPad* pad);

}  // namespace spidar
