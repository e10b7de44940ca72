// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What is reported on the bus about the samples of a haptic track.
#pragma once

#include <string>

#include <gst/gst.h>

#include "plugin/tracks/track_input.h"

namespace spidar {

/// Posts each warning once per stream. Streaming thread.
class TrackWarnings {
 public:
  explicit TrackWarnings(GstElement* element) : element_(element) {}

  /// A new stream begins: every warning may be posted again.
  void start() { *this = TrackWarnings(element_); }
  /// Looks at the faults so far, and at whether the last buffer had a time at which to feel it.
  /// `path` is that of the track, if it is a file.
  void check(const TrackFaults& faults, bool has_time, const std::string& path = "");

 private:
  GstElement* element_;
  bool not_finite_ = false, beyond_full_ = false, no_time_ = false;  // already posted
};

}  // namespace spidar
