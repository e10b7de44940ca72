// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What a format cannot hold of a track.
#pragma once

#include <string>

#include "plugin/tools/track_samples.h"
#include "plugin/tools/track_summary.h"

namespace spidar {

/// What save_track() with the same options has lost of a track, in whole lines: "lost: fx up to 1.2
/// N, steps of fy below 0.2 N". Empty for formats that hold all six channels.
std::string lost_in(const std::string& path, const TrackSummary& summary,
                    const SaveOptions& options);

/// Two digits: this is to be read, not to be computed with.
std::string rounded(double value);

}  // namespace spidar
