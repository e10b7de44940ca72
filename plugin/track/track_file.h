// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A haptic track in a file.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/track/track_block.h"
#include "plugin/track/track_input.h"

namespace spidar {

/// A whole track. The times of its blocks are those of the file, and rise.
struct TrackFile {
  std::vector<TrackBlock> blocks;
  int64_t duration_ns = 0;
  /// As long as the file says that it is; shorter than that it is cut off. 0: it does not say.
  int64_t promised_ns = 0;
  TrackFaults faults;

  /// Empty, or what is missing at the end of the file.
  std::string missing() const;
};

/// Reads the haptic track of a file, else its first sound, from any container that GStreamer has a
/// decoder for, in memory: 90
/// MB an hour. Throws std::runtime_error, which says what was wrong, when there is none, when it is
/// no haptic track (TrackInput::set_caps()), or when the file is damaged.
TrackFile read_track_file(const std::string& path);

}  // namespace spidar
