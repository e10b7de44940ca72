// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Keeps two programs from using one device file at the same time.
#pragma once

#include <cerrno>
#include <sys/file.h>

#include "spidar/realtime/monotonic.h"
#include "spidar/transports/transport.h"

namespace spidar {

/// Locks an open device file for this file descriptor until it is closed. Waits up to
/// Transport::kBusyPatience_ns, because a program that has just been killed, or its guardian, may
/// hold the lock a moment longer. Returns false and sets errno when the lock cannot be had;
/// EWOULDBLOCK means that somebody else holds it.
inline bool lock_device(int file) noexcept {
  const int64_t until_ns = monotonic_now_ns() + Transport::kBusyPatience_ns;
  while (flock(file, LOCK_EX | LOCK_NB) != 0) {
    if (errno != EWOULDBLOCK || monotonic_now_ns() > until_ns) return false;
    sleep_until_ns(monotonic_now_ns() + Transport::kBusyCheck_ns);
  }
  return true;
}

}  // namespace spidar
