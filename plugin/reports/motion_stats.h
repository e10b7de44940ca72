// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Numbers of an element, for its `stats` property.
#pragma once

#include <cstdint>
#include <mutex>
#include <optional>

#include <gst/gst.h>

#include "core/analysis/motion_analyzer.h"
#include "spidar/realtime/latency_histogram.h"
#include "spidar/session/haptic_session.h"

namespace spidar {

/// Since the stream began. Thread-safe.
class MotionStats {
 public:
  void reset();
  void add(const FrameAnalysis& frame, int64_t took_ns);

  /// Adds frames, restarts (uint64), features, tracked (uint, of the last frame), model (string: of
  /// the background in the last frame, 'none' when the motion that is felt needs none), objects
  /// (uint, in the last frame), analysis-ms-median, analysis-ms-p95, analysis-ms-max (double).
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

/// Adds device, device-state, scheduling (string), real-time (boolean), ticks, overruns,
/// exchange-errors, pose-errors, times-lost (uint64), pose-trouble (string: why the pose is not
/// known, 'none' while it is), motor-heat (double: of the warmest motor, 1 is what it may have for
/// ever), held-back (boolean: less force than wanted because a motor is warm or a string is out),
/// held-back-ticks (uint64), faulty-string (int, −1 when none),
/// grip-held (boolean: false when the force rests because nobody holds the grip), grip-speed
/// (double, m/s),
/// wakeup-us-median, wakeup-us-p999, skew-ms-median, skew-ms-p99 (double; skew: force at the device
/// after its frame was due on the screen), link-fault (string: the last one, see LinkFault),
/// link-timeouts, link-errors (all other faults), link-late-replies (uint64), round-trip-us-median,
/// round-trip-us-p99 (double; zero for a device without a link).
void describe_session(const HapticSession& session, GstStructure* structure);

}  // namespace spidar
