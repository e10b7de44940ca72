// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/timing/wrench_backlog.h"

namespace spidar {
namespace {

/// At least as many as fit into the loop's ring and its timeline together.
constexpr size_t kHandedOn = 512;

}  // namespace

void WrenchBacklog::connect(HapticLoop* loop) {
  const std::lock_guard<std::mutex> lock(mutex_);
  loop_ = loop;
  recent_.clear();
  handed_ = 0;
  refused_ = 0;
}

void WrenchBacklog::add(const TimedWrench& entry) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!loop_ || muted_) return;
  if (recent_.size() - handed_ == kMostWaiting) {
    ++refused_;
    return;
  }
  recent_.push_back(entry);
  recent_.back().time_ns += skipped_before_ns_;
  hand_on_locked();
}

void WrenchBacklog::hand_on() {
  const std::lock_guard<std::mutex> lock(mutex_);
  hand_on_locked();
}

void WrenchBacklog::hand_on_locked() {
  if (!loop_) return;
  for (; handed_ < recent_.size(); ++handed_) {
    TimedWrench shown = recent_[handed_];
    shown.time_ns = instant_rate_.at_sink(shown.time_ns);
    if (!loop_->schedule(shown)) break;
  }
  for (; handed_ > kHandedOn; --handed_) recent_.pop_front();
}

void WrenchBacklog::forget() {
  const std::lock_guard<std::mutex> lock(mutex_);
  forget_locked();
}

void WrenchBacklog::forget_locked() {
  recent_.clear();
  handed_ = 0;
  if (loop_) loop_->cancel_scheduled();
}

void WrenchBacklog::set_muted(bool muted) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (muted && !muted_) forget_locked();
  muted_ = muted;
}

void WrenchBacklog::change_rate(double multiplier, GstClockTime running_time,
                                GstClockTime upstream) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto skipped = static_cast<GstClockTime>(skipped_ns_);
  instant_rate_.change(multiplier, running_time + skipped, upstream + skipped);
  // Frames between here and the sink were analysed at the old rate and are shown at other times
  // now. The frame on the screen is the first of them, so that the force continues from there.
  while (recent_.size() > 1 && recent_[1].time_ns <= static_cast<int64_t>(upstream + skipped)) {
    recent_.pop_front();
  }
  handed_ = 0;
  if (loop_) loop_->cancel_scheduled();
  hand_on_locked();
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
  recent_.clear();
  handed_ = 0;
  skipped_ns_ = skipped_before_ns_ = 0;
}

uint64_t WrenchBacklog::refused() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return refused_;
}

}  // namespace spidar
