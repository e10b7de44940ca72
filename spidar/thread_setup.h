/// What a thread asks of the operating system.
#pragma once

#include <csignal>

#include "core/api.h"
#include "spidar/scheduling.h"

namespace spidar {

/// Above the kernel's threaded interrupts (50), so that disk and network do not delay a tick; below
/// its watchdogs and migration threads (99).
constexpr int kRealTimePriority = 80;

/// Asks for SCHED_FIFO for the calling thread, with kRealTimePriority or as much as is allowed.
SPIDAR_API Scheduling request_real_time();

/// Timers of the calling thread fire when they are due. The kernel's default is up to 50 µs later,
/// so that processors sleep longer. A real-time thread has no slack anyway.
void request_exact_timers() noexcept;

/// The calling thread yields to most others.
void request_background() noexcept;

/// While it lives, threads that this one starts have all signals blocked: an application's signals
/// are for the application's threads.
class SignalsBlocked {
 public:
  SignalsBlocked() noexcept;
  ~SignalsBlocked();
  SignalsBlocked(const SignalsBlocked&) = delete;
  SignalsBlocked& operator=(const SignalsBlocked&) = delete;

 private:
  sigset_t previous_;
};

}  // namespace spidar
