// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Numbers of an element, for its `stats` property.
#pragma once

#include <cstdint>
#include <mutex>
#include <optional>

#include <gst/gst.h>

#include "core/analysis/frame.h"
#include "spidar/realtime/latency_histogram.h"

namespace spidar {

/// Since the stream began. Thread-safe.
class MotionStats {
 public:
  void reset();
  void add(const Frame& frame, int64_t took_ns);

  uint64_t frames() const;

  /// Adds frames, restarts (uint64), features, tracked (uint, of the last frame), model (string: of
  /// the background in the last frame, 'none' when the motion that is felt needs none), objects
  /// (uint, in the last frame), analysis-median, analysis-p95, analysis-max (uint64, ns).
  void describe(GstStructure* structure) const;

 private:
  // 10 µs to 50 ms: more than that is too slow for any video.
  using AnalysisHistogram = DurationHistogram<5000, 10'000>;

  mutable std::mutex mutex_;
  uint64_t frames_ = 0;
  uint64_t restarts_ = 0;
  int features_ = 0;
  int tracked_ = 0;
  std::optional<ModelKind> model_;
  int objects_ = 0;
  AnalysisHistogram analysis_;
};

}  // namespace spidar
