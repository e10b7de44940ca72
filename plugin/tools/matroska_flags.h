// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Sets flags and language of a track in a Matroska file, which GStreamer's muxer cannot.
#pragma once

#include <string>

namespace spidar {

/// The title (GST_TAG_TITLE) for a track whose flags will be cleared later: it ends with room for
/// them. `name` must have 1 to 100 bytes.
std::string name_with_room(const std::string& name);

/// Marks the track of `path` whose name is name_with_room(`name`) as neither default nor enabled
/// (FlagDefault and FlagEnabled of RFC 9559), and as of no language ("zxx" of ISO 639-2), and
/// shortens its name to `name`, in place. Throws std::runtime_error when there is no such track.
void clear_track_flags(const std::string& path, const std::string& name);

}  // namespace spidar
