// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tracks/read_ahead.h"

namespace spidar {

bool ReadAhead::is_full() const {
  return !blocks_.empty() && (blocks_.size() >= kMaxBlocks ||
                              blocks_.back().begin_ns - blocks_.front().begin_ns > kAhead_ns);
}

bool ReadAhead::push(const TrackBlock& block, const tracks::Faults& faults) {
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait(lock, [this] { return !is_wanted() || !is_full(); });
  if (!is_wanted()) return false;
  faults_ = faults;
  if (end_of(block) <= sought_ns_ || block.begin_ns <= last_ns_) return true;
  last_ns_ = block.begin_ns;
  blocks_.push_back(block);
  changed_.notify_all();
  return true;
}

void ReadAhead::end_pass(const std::string& error) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (is_wanted()) set_end(error);
}

void ReadAhead::end(const std::string& error) {
  const std::lock_guard<std::mutex> lock(mutex_);
  set_end(error);
}

void ReadAhead::set_end(const std::string& error) {
  if (error_.empty()) error_ = error;
  ended_ = true;
  changed_.notify_all();
}

std::optional<int64_t> ReadAhead::await_seek() {
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait(lock, [this] { return stopped_ || next_pass_ != wanted_pass_; });
  if (stopped_) return std::nullopt;
  next_pass_ = wanted_pass_;
  return sought_ns_;
}

void ReadAhead::begin_pass() {
  const std::lock_guard<std::mutex> lock(mutex_);
  pass_ = next_pass_;
  last_ns_ = INT64_MIN;
}

void ReadAhead::set_later(int64_t later_ns) {
  const std::lock_guard<std::mutex> lock(mutex_);
  later_ns_ = later_ns;
}

void ReadAhead::seek(int64_t time_ns) {
  const std::lock_guard<std::mutex> lock(mutex_);
  ++wanted_pass_;
  sought_ns_ = time_ns - later_ns_;
  blocks_.clear();
  ended_ = !error_.empty();
  changed_.notify_all();
}

ReadAhead::Found ReadAhead::pop(TrackBlock& block, std::chrono::steady_clock::time_point limit) {
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait_until(lock, limit,
                      [this] { return !blocks_.empty() || ended_ || interrupted_ || stopped_; });
  if (blocks_.empty() && (ended_ || stopped_)) return Found::kEnd;
  if (blocks_.empty()) {
    late_ = late_ || !interrupted_;
    return Found::kLate;
  }
  block = blocks_.front();
  block.begin_ns += later_ns_;
  blocks_.pop_front();
  changed_.notify_all();
  return Found::kBlock;
}

std::string ReadAhead::error() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return error_;
}

bool ReadAhead::has_failed() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return !error_.empty() && blocks_.empty();
}

bool ReadAhead::was_late() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return late_;
}

tracks::Faults ReadAhead::faults() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return faults_;
}

void ReadAhead::set(bool& flag, bool value) {
  const std::lock_guard<std::mutex> lock(mutex_);
  flag = value;
  changed_.notify_all();
}

}  // namespace spidar
