// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tracks/block_schedule.h"

namespace spidar {

void BlockSchedule::connect(HapticLoop* loop) {
  const std::lock_guard<std::mutex> lock(mutex_);
  loop_ = loop;
  waiting_.clear();
  refused_ = 0;
}

void BlockSchedule::add(const TrackBlock& block) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!loop_ || muted_) return;
  if (waiting_.size() == kMostWaiting) {
    refused_ += block.count;
    return;
  }
  waiting_.push_back(block);
  hand_on_locked();
}

void BlockSchedule::hand_on() {
  const std::lock_guard<std::mutex> lock(mutex_);
  hand_on_locked();
}

void BlockSchedule::hand_on_locked() {
  if (!loop_) return;
  while (!waiting_.empty() && loop_->schedule(waiting_.front())) waiting_.pop_front();
}

void BlockSchedule::forget() {
  const std::lock_guard<std::mutex> lock(mutex_);
  forget_locked();
}

void BlockSchedule::forget_locked() {
  waiting_.clear();
  if (loop_) loop_->cancel_scheduled();
}

void BlockSchedule::set_muted(bool muted) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (muted && !muted_) forget_locked();
  muted_ = muted;
}

uint64_t BlockSchedule::refused() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return refused_;
}

}  // namespace spidar
