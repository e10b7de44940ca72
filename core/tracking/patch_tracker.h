// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The default tracker, with small windows and few memory accesses.
#pragma once

#include <memory>

#include "core/api.h"
#include "core/tracking/tracker.h"

namespace spidar {

/// Follows points in a picture reduced to about 480 px, with windows of 8 × 8 px from coarse to
/// fine, starting at the expected position. A forward–backward check verifies each point. Lost
/// points are searched again with the motion of their neighbours and by block matching. Found
/// points are refined in the frame if it has enough structure. New points are chosen cell by cell,
/// in a quarter of the empty cells per frame, and more densely where neighbours move differently. A
/// frame identical to the previous one costs one comparison.
class SPIDAR_API PatchTracker final : public Tracker {
 public:
  /// Throws as validate() does.
  explicit PatchTracker(const TrackerSettings& settings = {});
  ~PatchTracker() override;

  using Tracker::track;
  const TrackedFrame& track(const ImageView& frame, Repeats repeats) override;
  void restart() override;
  void configure(const TrackerSettings& settings) override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace spidar
