// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// System calls in programs that get signals, as from the timers of profilers and sequencers: some
/// calls fail then although the handler restarts calls (signal(7)).
#pragma once

#include <cerrno>
#include <cstdint>
#include <sys/ioctl.h>

#include "spidar/realtime/monotonic.h"

namespace spidar {

/// Repeats a call that a signal has interrupted.
template <typename Call>
auto uninterrupted(const Call& call) noexcept {
  auto result = call();
  while (result < 0 && errno == EINTR) result = call();
  return result;
}

/// Repeats a call that waits for a limited time, until the deadline. Each repetition waits anew.
template <typename Call>
auto uninterrupted_until(int64_t monotonic_ns, const Call& call) noexcept {
  auto result = call();
  while (result < 0 && errno == EINTR && monotonic_now_ns() < monotonic_ns) result = call();
  return result;
}

template <typename Argument>
int call_ioctl(int file, unsigned long request, Argument* argument) noexcept {
  return uninterrupted([&] { return ioctl(file, request, argument); });
}

}  // namespace spidar
