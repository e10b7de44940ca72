// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What spidarsink reports on the bus about the samples of a haptic track.
#pragma once

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
  void check(const TrackFaults& faults, bool has_time);

 private:
  GstElement* element_;
  bool not_finite_ = false, beyond_full_ = false, no_time_ = false;  // already posted
};

}  // namespace spidar
