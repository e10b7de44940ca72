// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory_resource>
#include <mutex>

#include <gst/gst.h>

#include "core/force/wrench_timeline.h"
#include "core/track/track_format.h"
#include "plugin/timing/instant_rate.h"
#include "spidar/loop/haptic_loop.h"

namespace spidar {

/// Forwards wrenches of frames or samples of a track to the haptic loop; entries beyond the loop's
/// capacity wait here. Thread-safe; without a loop, entries are discarded.
template <typename Entry>
class LoopQueue {
 public:
  /// While `most_waiting` entries wait, further ones are refused. The last `kept` forwarded entries
  /// stay here, for forward_again().
  explicit LoopQueue(size_t most_waiting, size_t kept = 0)
      : most_waiting_(most_waiting), kept_(kept) {}
  LoopQueue(const LoopQueue&) = delete;
  LoopQueue& operator=(const LoopQueue&) = delete;

  /// `loop` outlives the connection; null ends it.
  void connect(HapticLoop* loop) {
    const std::lock_guard<std::mutex> lock(mutex_);
    loop_ = loop;
    clear_entries();
    refused_ = 0;
  }
  /// The times of the entries must rise.
  void add(const Entry& entry) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!loop_ || muted_) return;
    if (entries_.size() - handed_ == most_waiting_) {
      refused_ += samples_in(entry);
      return;
    }
    entries_.push_back(entry);
    forward_locked();
  }
  /// Tries again to forward waiting entries. While playing, call this more often than every 50 ms.
  void forward_waiting() {
    const std::lock_guard<std::mutex> lock(mutex_);
    forward_locked();
  }
  /// Discards everything added so far, in the loop as well.
  void clear() {
    const std::lock_guard<std::mutex> lock(mutex_);
    clear_locked();
  }
  /// Discards entries while muted; muting also discards the earlier ones.
  void set_muted(bool muted) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (muted && !muted_) clear_locked();
    muted_ = muted;
  }
  /// Entries that a full queue has refused since the connection.
  uint64_t refused() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return refused_;
  }

 protected:
  // With the mutex held.
  void clear_entries() {
    entries_.clear();
    handed_ = 0;
  }
  /// Cancels the loop's entries and forwards all entries that are still here.
  void forward_again() {
    handed_ = 0;
    if (loop_) loop_->cancel_scheduled();
    forward_locked();
  }

  mutable std::mutex mutex_;
  InstantRate instant_rate_;  ///< for wrenches; samples have running times of the sink
  std::pmr::unsynchronized_pool_resource pool_;  ///< so that a queue that has grown needs no heap
  std::pmr::deque<Entry> entries_{&pool_};

 private:
  static uint64_t samples_in(const TimedWrench&) { return 1; }
  static uint64_t samples_in(const TrackBlock& block) { return block.count; }
  TimedWrench at_sink(TimedWrench wrench) const {
    const int64_t motion_ns = instant_rate_.at_sink(wrench.motion_ns());
    wrench.time_ns = instant_rate_.at_sink(wrench.time_ns);
    wrench.before_ns = wrench.time_ns - motion_ns;
    return wrench;
  }
  const TrackBlock& at_sink(const TrackBlock& block) const { return block; }

  void forward_locked() {
    if (!loop_) return;
    while (handed_ < entries_.size() && loop_->schedule(at_sink(entries_[handed_]))) ++handed_;
    for (; handed_ > kept_; --handed_) entries_.pop_front();
  }
  void clear_locked() {
    clear_entries();
    if (loop_) loop_->cancel_scheduled();
  }

  const size_t most_waiting_, kept_;
  HapticLoop* loop_ = nullptr;
  bool muted_ = false;
  size_t handed_ = 0;  ///< entries that the loop has, from the first one on
  uint64_t refused_ = 0;
};

/// Capacity of a LoopQueue<TrackBlock>, whose running times are those of the sink: 40 s of a track,
/// or 1 s in blocks of one sample each.
constexpr size_t kMaxBlocksWaiting = 1000;

/// Converts the running times of an element to those of the sink behind it. Waiting frames or a
/// long ts-offset may put seconds between the two.
class WrenchBacklog : public LoopQueue<TimedWrench> {
 public:
  /// More wrenches than wait for any sink: a quarter of an hour at 60 frames/s.
  static constexpr size_t kMaxWaiting = 1 << 16;
  /// Forwarded wrenches that are kept for a change of the rate, since the loop may not have
  /// rendered them: the capacity of its ring and its timeline together.
  static constexpr size_t kHandedOn = 512;
  WrenchBacklog() : LoopQueue(kMaxWaiting, kHandedOn) {}

  void add(TimedWrench wrench) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      wrench.time_ns += skipped_before_ns_;
    }
    LoopQueue::add(wrench);
  }

  /// From now on, the sink shows frames `multiplier` times as fast, see InstantRate::change().
  void change_rate(double multiplier, GstClockTime running_time, GstClockTime upstream) {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto skipped = static_cast<GstClockTime>(skipped_ns_);
    instant_rate_.change(multiplier, running_time + skipped, upstream + skipped);
    // Frames between here and the sink were analysed at the old rate, and their times change now.
    // The frame on the screen is the first of them, so that the force continues from there.
    while (entries_.size() > 1 && entries_[1].time_ns <= static_cast<int64_t>(upstream + skipped)) {
      entries_.pop_front();
    }
    forward_again();
  }
  double rate_multiplier() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return instant_rate_.multiplier();
  }
  /// The running time at the sink of a frame that is at `running_ns` here, as far as is known.
  int64_t at_sink_ns(int64_t running_ns) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return instant_rate_.at_sink(running_ns + skipped_before_ns_);
  }
  /// The sink has stepped over `duration` of running time and shows later frames that much earlier.
  void skip(GstClockTime duration) {
    const std::lock_guard<std::mutex> lock(mutex_);
    skipped_ns_ += static_cast<int64_t>(duration);
  }
  /// The running time, in ns, that the sink has stepped over since the last reset().
  int64_t skipped_ns() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return skipped_ns_;
  }
  /// Call this at a new segment: a sink that has stepped is then in time again.
  void begin_segment() {
    const std::lock_guard<std::mutex> lock(mutex_);
    skipped_before_ns_ = skipped_ns_;
  }
  void reset() {
    const std::lock_guard<std::mutex> lock(mutex_);
    instant_rate_.reset();
    clear_entries();
    skipped_ns_ = skipped_before_ns_ = 0;
  }

 private:
  int64_t skipped_ns_ = 0;         ///< by the sink, since the last flush
  int64_t skipped_before_ns_ = 0;  ///< the part before this segment
};

}  // namespace spidar
