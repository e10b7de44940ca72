// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The first half of the analysis: from pictures to what moves in them.
#pragma once

#include <cstdint>
#include <memory>

#include "core/analysis/measured_frame.h"
#include "core/image_view.h"
#include "core/tracking/tracker.h"

namespace spidar {

/// image → features → tracks → motion model → camera and objects. What it finds does not depend on
/// what is felt of it. One thread at a time.
class FrameMeter {
 public:
  /// What the result depends on.
  struct Settings {
    TrackerSettings tracker;
    bool mean_of_points = false;  ///< the paper's motion, without camera and objects
  };

  /// Throws std::invalid_argument when a setting is out of range, as configure() does.
  explicit FrameMeter(const Settings& settings);
  ~FrameMeter();

  /// Takes effect with the next frame; the tracks stay.
  void configure(const Settings& settings);

  /// See MotionAnalyzer::analyze(). Valid until the next call.
  const MeasuredFrame& measure(const ImageView& frame, int64_t running_time_ns);
  /// See MotionAnalyzer::repeat(); null in place of nothing.
  const MeasuredFrame* repeat(int64_t running_time_ns);
  /// The next frame has nothing to do with the one before.
  void restart();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace spidar
