// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What is to be felt when, on its way to the haptic loop.
#pragma once

#include <cstdint>
#include <deque>
#include <memory_resource>
#include <mutex>

#include <gst/gst.h>

#include "core/force/wrench_timeline.h"
#include "plugin/timing/instant_rate.h"
#include "spidar/loop/haptic_loop.h"

namespace spidar {

/// Turns the running times of an element into those of the sink behind it, and hands the wrenches
/// to the haptic loop. What the loop has no room for waits here: seconds of frames between the
/// element and the sink, or a long ts-offset. Thread-safe; without a loop everything is forgotten.
class WrenchBacklog {
 public:
  /// More than waits for any sink: a quarter of an hour at 60 frames/s. What comes then is refused.
  static constexpr size_t kMostWaiting = 1 << 16;

  /// `loop` outlives the connection; null ends it.
  void connect(HapticLoop* loop);

  /// Running time of the element.
  void add(const TimedWrench& entry);
  /// Again what waits. To be called while playing, more often than every 100 ms.
  void hand_on();
  /// Everything added so far.
  void forget();
  /// What is added while muted is forgotten.
  void set_muted(bool muted);

  /// The sink shows what comes `multiplier` times as fast from this moment on, see InstantRate.
  void change_rate(double multiplier, GstClockTime running_time, GstClockTime upstream);
  double rate_multiplier() const;
  /// Running time at the sink of a frame that has this running time here, as far as is known.
  int64_t at_sink_ns(int64_t running_ns) const;
  /// The sink has stepped over so much of running time: it shows what follows as much earlier.
  void skip(GstClockTime duration);
  /// Since running time began, in ns.
  int64_t skipped_ns() const;
  /// A sink that has skipped something is in time with the segment again.
  void begin_segment();
  /// Running time begins anew.
  void restart();

  /// Since the connection: because kMostWaiting were waiting.
  uint64_t refused() const;

 private:
  void hand_on_locked();
  void forget_locked();

  mutable std::mutex mutex_;
  HapticLoop* loop_ = nullptr;
  bool muted_ = false;
  InstantRate instant_rate_;
  int64_t skipped_ns_ = 0;         // by the sink, since the last flush
  int64_t skipped_before_ns_ = 0;  // of it, before this segment
  // Running times of the element. The first handed_ of them are the loop's already: as many as it
  // may not have felt are kept for a change of the rate.
  std::pmr::unsynchronized_pool_resource pool_;  // so that a queue that has grown needs no heap
  std::pmr::deque<TimedWrench> recent_{&pool_};
  size_t handed_ = 0;
  uint64_t refused_ = 0;
};

}  // namespace spidar
