// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/realtime/thread_setup.h"

#include <algorithm>
#include <cstring>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

namespace spidar {
namespace {

int request_fifo(int priority) {
  sched_param param{};
  param.sched_priority = priority;
  return pthread_setschedparam(pthread_self(), SCHED_FIFO, &param);
}

}  // namespace

Scheduling request_real_time() {
  int priority = kRealTimePriority;
  int error = request_fifo(priority);
  rlimit limit{};
  getrlimit(RLIMIT_RTPRIO, &limit);
  const auto allowed = static_cast<int>(std::min<rlim_t>(limit.rlim_cur, kRealTimePriority));
  if (error != 0 && allowed > 0) {
    priority = allowed;
    error = request_fifo(priority);
  }
  if (error == 0) return {true, "SCHED_FIFO " + std::to_string(priority)};
  const std::string wanted = std::to_string(kRealTimePriority);
  return {false, std::string("no real-time priority: ") + std::strerror(error) +
                     "; the limit of this process is " + std::to_string(allowed) + ", allow " +
                     wanted + " with \"@GROUP - rtprio " + wanted +
                     "\" in /etc/security/limits.d and a new login, or with LimitRTPRIO=" + wanted +
                     " in a systemd unit"};
}

std::string refused_thread(const char* name) {
  return std::string("the system refuses the thread ") + name +
         "; end other programs, or allow more threads and memory (ulimit -u and -v, TasksMax= of a "
         "systemd unit)";
}

void request_exact_timers() noexcept {
  prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL);
}

void request_background() noexcept {
  // On Linux a priority belongs to a thread, although POSIX defines it for processes.
  setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), 10);
}

SignalsBlocked::SignalsBlocked() noexcept {
  sigset_t all;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &previous_);
}

SignalsBlocked::~SignalsBlocked() {
  pthread_sigmask(SIG_SETMASK, &previous_, nullptr);
}

}  // namespace spidar
