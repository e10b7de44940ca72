// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <atomic>
#include <cstdint>
#include <future>
#include <thread>
#include <utility>

#include "spidar/loop/haptic_loop.h"
#include "spidar/realtime/monotonic.h"
#include "spidar/realtime/thread_setup.h"

namespace spidar {

/// The next deadline after a tick for `deadline_ns` that ended at `now_ns`: one period later, or
/// the first deadline of the same grid that is still ahead. Missed ticks are skipped: a burst of
/// exchanges would have no effect on the motors, and a thread that never sleeps would occupy a
/// processor.
constexpr int64_t next_deadline_ns(int64_t deadline_ns, int64_t now_ns) noexcept {
  const int64_t next = deadline_ns + kTick_ns;
  if (now_ns < next) return next;
  return next + ((now_ns - next) / kTick_ns + 1) * kTick_ns;
}

/// Runs a loop whose device is open once a millisecond, in a thread named "spidar-haptic".
/// Deadlines are absolute, so that delays do not accumulate. A lost device is reopened every
/// kRetry_ns until that succeeds.
///
/// Memory is not locked, because mlockall() would affect the whole process, which belongs to the
/// player. All data of a tick is in the loop object and is accessed a thousand times a second.
class LoopThread {
 public:
  static constexpr int64_t kRetry_ns = 250'000'000;

  /// Returns when the thread runs and its scheduling is known. Throws std::system_error if the
  /// thread cannot be created. `loop` must outlive this object.
  LoopThread(HapticLoop& loop, bool ask_for_real_time) : loop_(loop) {
    std::promise<Scheduling> scheduled;
    std::future<Scheduling> scheduling = scheduled.get_future();
    auto body = [this, ask_for_real_time, scheduled = std::move(scheduled)]() mutable {
      request_exact_timers();
      scheduled.set_value(ask_for_real_time
                              ? request_real_time()
                              : Scheduling{false, "real-time priority not asked for"});
      run();
    };
    thread_ = start_thread("spidar-haptic", std::move(body));
    scheduling_ = scheduling.get();
  }
  ~LoopThread() { stop(); }

  /// Ramps to zero, closes the device, ends the thread. May be called twice.
  void stop() noexcept {
    loop_.begin_close();
    if (thread_.joinable()) thread_.join();
  }

  const Scheduling& scheduling() const noexcept { return scheduling_; }
  const LoopTiming& timing() const noexcept { return timing_; }

 private:
  void run() noexcept {
    int64_t deadline = monotonic_now_ns() + kTick_ns;
    int64_t next_try = 0;
    for (;;) {
      sleep_until_ns(deadline);
      const int64_t begin = monotonic_now_ns();
      loop_.tick(deadline, begin);
      const int64_t end = monotonic_now_ns();
      timing_.lateness.add(begin - deadline);
      timing_.cycle.add(end - begin);
      if (loop_.released()) break;
      deadline = next_deadline_ns(deadline, end);
      if (loop_.lost() && end >= next_try) {
        loop_.reopen();
        next_try = monotonic_now_ns() + kRetry_ns;
        // The duration of reopen() says nothing about the scheduler.
        deadline = monotonic_now_ns() + kTick_ns;
      }
    }
    loop_.close();
  }

  HapticLoop& loop_;
  Scheduling scheduling_;
  LoopTiming timing_;
  std::thread thread_;
};

}  // namespace spidar
