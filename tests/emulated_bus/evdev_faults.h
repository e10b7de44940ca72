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

inline void forget_faults(EvdevPort& port) {
  port.query_error = port.event_error = port.interruptions = 0;
  port.cuts_events = port.hangs = false;
  port.axis_end = 1000;
}

/// Returns when the driver no longer hangs. Returns the error of an upload, −errno, or 0.
inline int upload_fault(EvdevPort& port) {
  if (port.hangs) {
    ++port.hanging;
    while (port.hangs && port.kind != EvdevKind::kNone)
      sleep_until_ns(monotonic_now_ns() + kSecond_ns / 1000);
    --port.hanging;
  }
  if (port.kind == EvdevKind::kNone) return -ENODEV;
  if (port.interruptions == 0) return 0;
  --port.interruptions;
  return -EINTR;
}

/// The error of an ioctl() other than an upload, −errno, or 0.
inline int query_fault(const EvdevPort& port, unsigned long request) {
  const bool of_position = request == EVIOCGEFFECTS || _IOC_NR(request) >= _IOC_NR(EVIOCGABS(0));
  return of_position ? -port.query_error : 0;
}

/// Whether the driver does not take all of an event of `length` bytes; then `result` is that of
/// write().
inline bool write_fault(const EvdevPort& port, size_t length, long& result) {
  const int error = port.event_error;
  if (error == 0 && !port.cuts_events) return false;
  errno = error;
  result = error == 0 ? static_cast<long>(length / 2) : -1;
  return true;
}

}  // namespace spidar::test
