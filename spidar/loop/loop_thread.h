// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The thread that gives the haptic loop its millisecond.
#pragma once

#include <atomic>
#include <cstdint>
#include <thread>

#include "spidar/loop/haptic_loop.h"
#include "spidar/realtime/scheduling.h"

namespace spidar {

/// Next deadline after a tick for `deadline_ns` that ended at `now_ns`: a period later, or on the
/// same grid the first one ahead. What was missed is left out: exchanges in a burst move nothing,
/// and a thread that never sleeps would take a processor for itself.
constexpr int64_t next_deadline_ns(int64_t deadline_ns, int64_t now_ns) noexcept {
  const int64_t next = deadline_ns + kTick_ns;
  if (now_ns < next) return next;
  return next + ((now_ns - next) / kTick_ns + 1) * kTick_ns;
}

/// Runs a loop whose device is open, "spidar-haptic" by name. Absolute deadlines, so that lateness
/// does not add up. A lost device is tried again every kRetry_ns.
///
/// Memory is not locked: mlockall() would be for the whole process, which belongs to the player.
/// All that a tick touches is in the loop object and is touched a thousand times a second.
class LoopThread {
 public:
  static constexpr int64_t kRetry_ns = 250'000'000;

  /// Returns when the thread runs and its scheduling is known. Throws std::system_error when there
  /// can be no thread. `loop` outlives it.
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
