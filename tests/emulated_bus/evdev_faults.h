// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What the driver of an emulated input device does wrong, as EvdevPort says.
#pragma once

#include <cerrno>
#include <cstddef>
#include <linux/input.h>
#include <sys/ioctl.h>

#include "spidar/realtime/monotonic.h"
#include "tests/emulated_bus/evdev_port.h"

namespace spidar::test {

/// Takes as long as the driver does for an upload. Returns its error, −errno, or 0.
inline int upload_fault(EvdevPort& port) {
  constexpr int64_t kMs = kSecond_ns / 1000;
  const int64_t now_ns = monotonic_now_ns();
  if (port.upload_ms > 0) sleep_until_ns(now_ns + port.upload_ms * kMs);
  if (port.hangs) {
    ++port.hanging;
    while (port.hangs && port.kind != EvdevKind::kNone) sleep_until_ns(monotonic_now_ns() + kMs);
    --port.hanging;
  }
  if (port.kind == EvdevKind::kNone) return -ENODEV;
  if (port.interruptions > 0) {
    --port.interruptions;
    ++port.interrupted;
    return -EINTR;
  }
  return -port.upload_error;
}

/// The error of an ioctl() other than an upload, −errno, or 0.
inline int query_fault(const EvdevPort& port, unsigned long request) {
  const bool of_position = request == EVIOCGEFFECTS || _IOC_NR(request) >= _IOC_NR(EVIOCGABS(0));
  return of_position ? -port.query_error : 0;
}

/// What write() of an event of `length` bytes returns; sets errno if that is not `length`.
inline long written(const EvdevPort* port, size_t length) {
  const int error = port ? port->event_error.load() : ENODEV;
  if (error == 0 && !port->cuts_events) return static_cast<long>(length);
  errno = error;
  return error == 0 ? static_cast<long>(length / 2) : -1;
}

}  // namespace spidar::test
