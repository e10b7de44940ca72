// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The thread that runs the haptic loop once a millisecond.
#pragma once

#include <atomic>
#include <cstdint>
#include <thread>

#include "spidar/loop/haptic_loop.h"
#include "spidar/realtime/thread_setup.h"

namespace spidar {

/// Next deadline after a tick for `deadline_ns` that ended at `now_ns`: one period later, or the
/// first deadline of the same grid that is still ahead. Missed ticks are skipped: a burst of
/// exchanges would have no effect on the motors, and a thread that never sleeps would occupy a
/// processor.
constexpr int64_t next_deadline_ns(int64_t deadline_ns, int64_t now_ns) noexcept {
  const int64_t next = deadline_ns + kTick_ns;
  if (now_ns < next) return next;
  return next + ((now_ns - next) / kTick_ns + 1) * kTick_ns;
}

/// Runs a loop whose device is open, in a thread named "spidar-haptic". Deadlines are absolute, so
/// that delays do not accumulate. A lost device is reopened every kRetry_ns until that succeeds.
///
/// Memory is not locked, because mlockall() would affect the whole process, which belongs to the
/// player. All data that a tick uses is in the loop object and is accessed a thousand times a
/// second.
class LoopThread {
 public:
  static constexpr int64_t kRetry_ns = 250'000'000;

  /// Returns when the thread runs and its scheduling is known. Throws std::system_error if the
  /// thread cannot be created. `loop` must outlive this object.
  LoopThread(HapticLoop& loop, bool ask_for_real_time);
  /// stop()
  ~LoopThread();

  /// Ramps to zero, closes the device, ends the thread. Safe to call twice.
  void stop() noexcept;

  const Scheduling& scheduling() const noexcept { return scheduling_; }
  const LoopTiming& timing() const noexcept { return timing_; }

 private:
  void run() noexcept;

  HapticLoop& loop_;
  Scheduling scheduling_;
  LoopTiming timing_;
  std::thread thread_;
};

}  // namespace spidar
