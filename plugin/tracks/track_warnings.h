// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <string>

#include <gst/gst.h>

#include "plugin/tracks/track_input.h"

namespace spidar::tracks {

/// Warns about faults of a haptic track that is felt, once per stream. Streaming thread.
class Warnings {
 public:
  explicit Warnings(GstElement* element) : element_(element) {}

  /// Begins a stream: every warning may be posted again.
  void start() { *this = Warnings(element_); }
  /// Warns that nothing marks the stream as a haptic track, so that it is not rendered.
  void warn_of_missing_mark();
  /// Warns that sync=false was set.
  void warn_of_sync();
  /// Checks the faults so far, and whether the last buffer had a time at which to render it. `path`
  /// is that of the track, if it is a file.
  void check(const Faults& faults, bool has_time, const std::string& path = "");

 private:
  GstElement* element_;
  // Whether each of these warnings was posted.
  bool not_finite_ = false, beyond_full_ = false, is_sound_ = false, no_time_ = false,
       unmarked_ = false;
};

}  // namespace spidar::tracks
