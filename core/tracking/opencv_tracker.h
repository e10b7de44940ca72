// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The tracker of the paper: Shi–Tomasi points, pyramidal Lucas–Kanade.
#pragma once

#include <memory>

#include "core/api.h"
#include "core/tracking/tracker.h"

namespace spidar {

/// Follows points in a picture reduced to about 480 px, with one pyramid a frame that is kept for
/// the next one. Points that leave the picture, are not found, do not come back when followed
/// backwards, or look different are dropped. New ones are selected when points thin out and every
/// few frames, so that an object that enters is found.
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
