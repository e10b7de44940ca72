// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Priority, timers and signals of a thread.
#pragma once

#include <csignal>
#include <pthread.h>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

#include "spidar/realtime/latency_histogram.h"

namespace spidar {

struct Scheduling {
  bool real_time = false;
  std::string detail;  ///< "SCHED_FIFO 80", or the reason and what would help
};

/// The timing of all ticks since the thread was started. Readable while the thread runs.
struct LoopTiming {
  LatencyHistogram lateness;  ///< time from the deadline to the beginning of the tick
  LatencyHistogram cycle;     ///< time from the beginning of the tick to its end, with the exchange
};

/// Above the kernel's threaded interrupts (50), so that disk and network do not delay a tick; below
/// its watchdogs and migration threads (99).
constexpr int kRealTimePriority = 80;

/// Requests SCHED_FIFO for the calling thread, up to kRealTimePriority as far as permitted.
Scheduling request_real_time();

/// Makes timers of the calling thread fire when they are due. By default, the kernel fires them up
/// to 50 µs later, so that processors sleep longer. A real-time thread has no slack anyway.
void request_exact_timers() noexcept;

void request_background() noexcept;

/// While this object lives, threads that the calling thread starts have all signals blocked.
class SignalsBlocked {
 public:
  SignalsBlocked() noexcept;
  ~SignalsBlocked();
  SignalsBlocked(const SignalsBlocked&) = delete;
  SignalsBlocked& operator=(const SignalsBlocked&) = delete;

 private:
  sigset_t previous_;
};

/// Returns what was refused, and what would help: a sentence for std::system_error.
std::string refused_thread(const char* name);

/// Starts a thread. The library starts all its threads here, with a name of up to 15 characters for
/// debuggers and top, and with all signals blocked, so that signals reach the application's own
/// threads. Throws std::system_error, which says what was refused and what would help.
template <typename Function>
std::thread start_thread(const char* name, Function run) {
  const SignalsBlocked blocked;
  try {
    return std::thread([name, run = std::move(run)]() mutable {
      pthread_setname_np(pthread_self(), name);
      run();
    });
  } catch (const std::system_error& error) {
    throw std::system_error(error.code(), refused_thread(name));
  }
}

}  // namespace spidar
