// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The thread that writes the haptic trace, so that the haptic thread touches no file.
#pragma once

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

#include "spidar/loop/haptic_loop.h"
#include "spidar/loop/tick_trace.h"

namespace spidar {

/// Takes the records of a loop every 50 ms, of which the loop can keep more than four seconds.
class TraceThread {
 public:
  /// Throws TraceError when the file cannot be written. `loop` outlives it. Without
  /// `threaded`, records are only taken by drain() and at the end.
  TraceThread(const std::string& path, HapticLoop& loop, bool threaded);
  /// Writes what is left.
  ~TraceThread();

  /// Writes all ticks so far.
  void drain() noexcept;

  TraceStatus status() const noexcept;
  /// TraceStatus::error, without waiting for a file.
  int error() const noexcept { return error_.load(std::memory_order_relaxed); }

 private:
  void run() noexcept;
  void drain_locked() noexcept;

  HapticLoop& loop_;
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  bool stop_ = false;
  TickTrace trace_;
  std::atomic<int> error_{0};
  std::thread thread_;
};

}  // namespace spidar
