// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Which track is felt for a film, and what is wrong with it.
#pragma once

#include <cstdint>
#include <optional>

#include <gst/gst.h>

#include "plugin/tracks/track_loader.h"

namespace spidar {

/// The track to be felt for the film that comes to the sink pad of `element`. Nothing when there is
/// none; a warning on the bus when it cannot be used, or is that of another film.
std::optional<TrackFile> judge_track(GstElement* element, LoadedTrack loaded, int64_t frame_ns);

}  // namespace spidar
