// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What a format cannot hold of a track.
#pragma once

#include <string>
#include <vector>

#include "plugin/tools/track_samples.h"

namespace spidar {

/// What save_track() with the same arguments has lost, in whole lines: "lost: fx up to 1.2 N, steps
/// of fy below 0.2 N". Empty for formats that hold all six channels.
std::string lost_in(const std::string& path, const std::vector<TrackSample>& samples,
                    const SaveOptions& options);

}  // namespace spidar
