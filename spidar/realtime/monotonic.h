// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The clock of the haptic loop, and times for the operating system.
#pragma once

#include <cerrno>
#include <cstdint>
#include <ctime>

namespace spidar {

constexpr int64_t kSecond_ns = 1'000'000'000;

inline int64_t clock_ns(clockid_t clock) noexcept {
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<int64_t>(now.tv_sec) * kSecond_ns + now.tv_nsec;
}

inline timespec to_timespec(int64_t ns) noexcept {
  return {static_cast<time_t>(ns / kSecond_ns), static_cast<long>(ns % kSecond_ns)};
}

inline int64_t monotonic_now_ns() noexcept {
  return clock_ns(CLOCK_MONOTONIC);
}

/// Sleeps until this time, in spite of signals. Returns at once when the time is past.
inline void sleep_until_ns(int64_t monotonic_ns) noexcept {
  const timespec until = to_timespec(monotonic_ns);
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
}

}  // namespace spidar
