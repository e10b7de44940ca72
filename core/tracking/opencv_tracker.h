// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The tracker of the paper: Shi–Tomasi points and pyramidal Lucas–Kanade.
#pragma once

#include <memory>

#include "core/api.h"
#include "core/tracking/tracker.h"

namespace spidar {

/// Follows points in a picture reduced to about 480 px, and builds one pyramid per frame, which is
/// reused for the next frame. Drops points that leave the picture, are not found, fail the
/// forward–backward check, or look different. Selects new points when few are left and every few
/// frames, so that objects that enter are found.
class SPIDAR_API OpenCvTracker final : public Tracker {
 public:
  /// Throws as validate() does.
  explicit OpenCvTracker(const TrackerSettings& settings = {});
  ~OpenCvTracker() override;

  using Tracker::track;
  const TrackedFrame& track(const ImageView& frame, Repeats repeats) override;
  void restart() override;
  void configure(const TrackerSettings& settings) override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace spidar
