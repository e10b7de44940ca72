// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// How the haptic thread is scheduled and how well that works.
#pragma once

#include <string>

#include "spidar/realtime/latency_histogram.h"

namespace spidar {

/// Whether the loop's thread runs with real-time priority, and if not, why.
struct Scheduling {
  bool real_time = false;
  std::string detail;  ///< "SCHED_FIFO 80", or the reason and what would help
};

/// Timing of all ticks since the thread was started. Readable while it runs.
struct LoopTiming {
  LatencyHistogram lateness;  ///< from the deadline to the beginning of the tick
  LatencyHistogram cycle;     ///< from the beginning of the tick to its end, device included
};

}  // namespace spidar
