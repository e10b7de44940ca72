// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The tracker of the paper: Shi–Tomasi points and pyramidal Lucas–Kanade.
#pragma once

#include <memory>

#include "core/tracking/tracker.h"

namespace spidar {

/// Follows points in a picture reduced to about 480 px, and builds one pyramid per frame, which is
/// reused for the next frame. Drops points that leave the picture, are not found, fail the
/// forward–backward check, or look different. Selects new points when few are left and every few
/// frames, so that objects that enter are found.
class OpenCvTracker {
 public:
  /// Throws as validate() does.
  explicit OpenCvTracker(const TrackerSettings& settings = {});
  ~OpenCvTracker();

  /// Compares `frame` with the previous one. A frame of another size restarts the tracks, as does a
  /// cut (a frame in which hardly any point is found again). Of a frame that repeats the picture,
  /// tracks are at rest. With `may_wait`, one that is equal within the noise of coding counts as
  /// kSame, too, and tracks stay those of the frame before. The result is valid until the next
  /// call. Throws as require_usable() does.
  const TrackedFrame& track(const ImageView& frame, bool may_wait = false);

  /// Discards the previous frame, so that the next one starts anew without motion.
  void restart();

  /// Takes effect with the next frame. Throws as validate() does, and then changes nothing.
  void configure(const TrackerSettings& settings);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace spidar
