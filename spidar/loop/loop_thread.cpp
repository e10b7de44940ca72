// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/loop/loop_thread.h"

#include <future>
#include <utility>

#include "spidar/realtime/monotonic.h"
#include "spidar/realtime/thread_setup.h"

namespace spidar {

LoopThread::LoopThread(HapticLoop& loop, bool ask_for_real_time) : loop_(loop) {
  std::promise<Scheduling> scheduled;
  std::future<Scheduling> scheduling = scheduled.get_future();
  auto body = [this, ask_for_real_time, scheduled = std::move(scheduled)]() mutable {
    request_exact_timers();
    scheduled.set_value(ask_for_real_time ? request_real_time()
                                          : Scheduling{false, "real-time priority not asked for"});
    run();
  };
  thread_ = start_thread("spidar-haptic", std::move(body));
  scheduling_ = scheduling.get();
}

LoopThread::~LoopThread() {
  stop();
}

void LoopThread::stop() noexcept {
  loop_.begin_close();
  if (thread_.joinable()) thread_.join();
}

void LoopThread::run() noexcept {
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
      // The duration of this says nothing about the scheduler.
      deadline = monotonic_now_ns() + kTick_ns;
    }
  }
  loop_.close();
}

}  // namespace spidar
