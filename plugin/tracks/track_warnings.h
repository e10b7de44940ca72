// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Warnings about a haptic track that is felt, but not as it should be.
#pragma once

#include <string>

#include <gst/gst.h>

#include "plugin/tracks/track_input.h"

namespace spidar::tracks {

/// Posts each warning once per stream. Streaming thread.
class Warnings {
 public:
  explicit Warnings(GstElement* element) : element_(element) {}

  /// A new stream begins: every warning may be posted again.
  void start() { *this = Warnings(element_); }
  /// Nothing marks the stream as a haptic track, and it is not rendered.
  void tell_of_mark();
  /// The property sync=false was set.
  void tell_of_sync();
  /// Looks at the faults so far, and at whether the last buffer had a time at which to render it.
  /// `path` is that of the track, if it is a file.
  void check(const Faults& faults, bool has_time, const std::string& path = "");

 private:
  GstElement* element_;
  // Already posted.
  bool not_finite_ = false, beyond_full_ = false, is_sound_ = false, no_time_ = false,
       unmarked_ = false;
};

}  // namespace spidar::tracks
