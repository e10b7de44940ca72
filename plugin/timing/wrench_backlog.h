// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Wrenches of frames, from the time of the element to that of the sink.
#pragma once

#include <cstdint>

#include <gst/gst.h>

#include "core/force/wrench_timeline.h"
#include "plugin/timing/instant_rate.h"
#include "plugin/timing/loop_queue.h"

namespace spidar {

/// Turns the running times of an element into those of the sink behind it. Seconds of frames may
/// wait between the element and the sink, or a long ts-offset.
class WrenchBacklog : public LoopQueue<TimedWrench> {
 public:
  /// More than waits for any sink: a quarter of an hour at 60 frames/s.
  static constexpr size_t kMostWaiting = 1 << 16;
  /// As many as the loop may not have rendered are kept for a change of the rate: at least as many
  /// as fit into its ring and its timeline together.
  static constexpr size_t kHandedOn = 512;
  WrenchBacklog() : LoopQueue(kMostWaiting, kHandedOn) {}

  /// The sink shows what comes `multiplier` times as fast from this moment on, see InstantRate.
  void change_rate(double multiplier, GstClockTime running_time, GstClockTime upstream) {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto skipped = static_cast<GstClockTime>(skipped_ns_);
    instant_rate_.change(multiplier, running_time + skipped, upstream + skipped);
    // Frames between here and the sink were analysed at the old rate and are shown at other times
    // now. The frame on the screen is the first of them, so that the force continues from there.
    while (entries_.size() > 1 && entries_[1].time_ns <= static_cast<int64_t>(upstream + skipped)) {
      entries_.pop_front();
    }
    forward_again();
  }
  double rate_multiplier() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return instant_rate_.multiplier();
  }
  /// Running time at the sink of a frame that has this running time here, as far as is known.
  int64_t at_sink_ns(int64_t running_ns) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return instant_rate_.at_sink(running_ns + skipped_before_ns_);
  }
  /// The sink has stepped over so much of running time: it shows what follows as much earlier.
  void skip(GstClockTime duration) {
    const std::lock_guard<std::mutex> lock(mutex_);
    skipped_ns_ += static_cast<int64_t>(duration);
  }
  /// Since running time began, in ns.
  int64_t skipped_ns() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return skipped_ns_;
  }
  /// A sink that has skipped something is in time with the segment again.
  void begin_segment() {
    const std::lock_guard<std::mutex> lock(mutex_);
    skipped_before_ns_ = skipped_ns_;
  }
  /// Running time begins anew.
  void reset() {
    const std::lock_guard<std::mutex> lock(mutex_);
    instant_rate_.reset();
    clear_entries();
    skipped_ns_ = skipped_before_ns_ = 0;
  }

 private:
  void enter(TimedWrench& entry) override { entry.time_ns += skipped_before_ns_; }
  TimedWrench shown(const TimedWrench& entry) const override {
    TimedWrench shown = entry;
    shown.time_ns = instant_rate_.at_sink(entry.time_ns);
    shown.before_ns = shown.time_ns - instant_rate_.at_sink(entry.motion_ns());
    return shown;
  }

  InstantRate instant_rate_;
  int64_t skipped_ns_ = 0;         ///< by the sink, since the last flush
  int64_t skipped_before_ns_ = 0;  ///< of it, before this segment
};

}  // namespace spidar
