// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Priority, timers and signals of a thread.
#pragma once

#include <csignal>
#include <pthread.h>
#include <thread>
#include <utility>

#include "spidar/realtime/scheduling.h"

namespace spidar {

/// Above the kernel's threaded interrupts (50), so that disk and network do not delay a tick; below
/// its watchdogs and migration threads (99).
constexpr int kRealTimePriority = 80;

/// Asks for SCHED_FIFO for the calling thread, with kRealTimePriority or as much as is allowed.
Scheduling request_real_time();

/// Timers of the calling thread fire when they are due. The kernel's default is up to 50 µs later,
/// so that processors sleep longer. A real-time thread has no slack anyway.
void request_exact_timers() noexcept;

/// Gives the calling thread a low priority.
void request_background() noexcept;

/// During its lifetime, threads that the calling thread starts have all signals blocked.
class SignalsBlocked {
 public:
  SignalsBlocked() noexcept;
  ~SignalsBlocked();
  SignalsBlocked(const SignalsBlocked&) = delete;
  SignalsBlocked& operator=(const SignalsBlocked&) = delete;

 private:
  sigset_t previous_;
};

/// Starts a thread. All threads of this library are started here, with a name of up to 15
/// characters for debuggers and top, and with all signals blocked, so that signals reach the
/// application's own threads. Throws std::system_error.
template <typename Function>
std::thread start_thread(const char* name, Function run) {
  const SignalsBlocked blocked;
  return std::thread([name, run = std::move(run)]() mutable {
    pthread_setname_np(pthread_self(), name);
    run();
  });
}

}  // namespace spidar
