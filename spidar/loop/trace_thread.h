// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The thread that writes the haptic trace, so that the haptic thread does not access files.
#pragma once

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

#include "spidar/loop/haptic_loop.h"
#include "spidar/loop/tick_trace.h"

namespace spidar {

/// Reads the records of a loop every 50 ms. The loop can store more than four seconds of them.
class TraceThread {
 public:
  /// Throws TraceError when the file cannot be written. `loop` must outlive this object. Without
  /// `threaded`, records are only read by drain() and at the end.
  TraceThread(const std::string& path, HapticLoop& loop, bool threaded);
  /// Writes the remaining records.
  ~TraceThread();

  /// Writes all records so far.
  void drain() noexcept;

  /// TraceStatus::error, without waiting for the file.
  int error() const noexcept { return error_.load(std::memory_order_relaxed); }

 private:
  void run() noexcept;
  void drain_locked() noexcept;

  HapticLoop& loop_;
  std::mutex mutex_;
  std::condition_variable wake_;
  bool stop_ = false;
  TickTrace trace_;
  std::atomic<int> error_{0};
  std::thread thread_;
};

}  // namespace spidar
