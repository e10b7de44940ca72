// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Flags of a track in a Matroska file, which GStreamer's muxer does not set.
#pragma once

#include <string>

namespace spidar {

/// The name to give to a track (GST_TAG_TITLE) whose flags are to be cleared later: it has room for
/// them at its end. `name`: not empty, and at most 100 bytes.
std::string name_with_room(const std::string& name);

/// Marks the track of `path` whose name is name_with_room(`name`) as not default and not enabled
/// (FlagDefault and FlagEnabled of RFC 9559), and shortens its name to `name`, in place. Throws
/// std::runtime_error when there is no such track.
void clear_track_flags(const std::string& path, const std::string& name);

}  // namespace spidar
