// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Samples of a track on their way to the haptic loop.
#pragma once

#include <cstdint>
#include <deque>
#include <memory_resource>
#include <mutex>

#include "core/track/track_format.h"
#include "spidar/loop/haptic_loop.h"

namespace spidar {

/// Hands blocks to the haptic loop; what that has no room for waits here. Thread-safe; without a
/// loop everything is forgotten.
class BlockSchedule {
 public:
  /// 40 s of a track, or 1 s in blocks of one sample each. What comes then is refused.
  static constexpr size_t kMostWaiting = 1000;

  /// `loop` outlives the connection; null ends it.
  void connect(HapticLoop* loop);
  /// Running times must rise.
  void add(const TrackBlock& block);
  /// Again what waits. To be called while playing, more often than every 50 ms.
  void hand_on();
  /// Everything added so far.
  void forget();
  /// What is added while muted is forgotten.
  void set_muted(bool muted);
  /// Since the connection: samples of which more than kMostWaiting blocks were waiting.
  uint64_t refused() const;

 private:
  void hand_on_locked();
  void forget_locked();

  mutable std::mutex mutex_;
  HapticLoop* loop_ = nullptr;
  bool muted_ = false;
  std::pmr::unsynchronized_pool_resource pool_;  // so that a queue that has grown needs no heap
  std::pmr::deque<TrackBlock> waiting_{&pool_};
  uint64_t refused_ = 0;
};

}  // namespace spidar
