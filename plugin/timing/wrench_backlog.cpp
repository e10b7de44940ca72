// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/timing/wrench_backlog.h"

namespace spidar {

TimedWrench WrenchBacklog::shown(const TimedWrench& entry) const {
  TimedWrench shown = entry;
  shown.time_ns = instant_rate_.at_sink(shown.time_ns);
  return shown;
}

void WrenchBacklog::change_rate(double multiplier, GstClockTime running_time,
                                GstClockTime upstream) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto skipped = static_cast<GstClockTime>(skipped_ns_);
  instant_rate_.change(multiplier, running_time + skipped, upstream + skipped);
  // Frames between here and the sink were analysed at the old rate and are shown at other times
  // now. The frame on the screen is the first of them, so that the force continues from there.
  while (entries_.size() > 1 && entries_[1].time_ns <= static_cast<int64_t>(upstream + skipped)) {
    entries_.pop_front();
  }
  hand_on_again();
}

double WrenchBacklog::rate_multiplier() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return instant_rate_.multiplier();
}

int64_t WrenchBacklog::at_sink_ns(int64_t running_ns) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return instant_rate_.at_sink(running_ns + skipped_before_ns_);
}

void WrenchBacklog::skip(GstClockTime duration) {
  const std::lock_guard<std::mutex> lock(mutex_);
  skipped_ns_ += static_cast<int64_t>(duration);
}

int64_t WrenchBacklog::skipped_ns() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return skipped_ns_;
}

void WrenchBacklog::begin_segment() {
  const std::lock_guard<std::mutex> lock(mutex_);
  skipped_before_ns_ = skipped_ns_;
}

void WrenchBacklog::restart() {
  const std::lock_guard<std::mutex> lock(mutex_);
  instant_rate_.reset();
  clear();
  skipped_ns_ = skipped_before_ns_ = 0;
}

}  // namespace spidar
