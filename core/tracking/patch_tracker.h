// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The tracker of this project: small windows, few pixels touched.
#pragma once

#include <memory>

#include "core/api.h"
#include "core/tracking/tracker.h"

namespace spidar {

/// Follows points in a picture reduced to about 480 px, on windows of 8 × 8 px from coarse to fine,
/// beginning where the point was expected; checks each by following it back; retries those that
/// were lost from where their neighbours went and by comparing blocks; and refines the rest in the
/// frame itself where its structure is worth it. Points are chosen cell by cell, a quarter of the
/// empty cells a frame, and denser where neighbours move differently.
/// A frame that is the same as the one before costs one comparison.
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
