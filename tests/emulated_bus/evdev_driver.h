// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The driver of an emulated input device: the parts of evdev that force feedback uses, and what
/// EvdevPort says that the driver does wrong.
#pragma once

#include <cstddef>

#include "spidar/devices/force_feedback/packets.h"
#include "tests/emulated_bus/evdev_port.h"

struct ff_effect;

namespace spidar::test {

void erase_effects(EvdevPort& port);

/// Whether it was started and has not ended.
bool is_playing(const EvdevPort& port, const EvdevPort::Effect& effect);

/// As after plugging it in, without faults.
void reset(EvdevPort& port);

class EvdevDriver {
 public:
  explicit EvdevDriver(EvdevPort& port) : port_(port) {}

  /// Answers an ioctl(). Returns its result, or −errno.
  int call(unsigned long request, void* argument);

  /// Carries out an event that was written. Returns 0, or −errno.
  int event(const ff::Event& event);

  /// Whether the driver does not take all of an event of `length` bytes; then `result` is that of
  /// write(2).
  static bool write_fails(const EvdevPort& port, size_t length, long& result);

 private:
  int upload(ff_effect& effect);
  int erase(size_t number);
  int query(unsigned long request, void* argument);
  /// Whether a signal interrupts this call.
  bool is_interrupted();

  EvdevPort& port_;
};

}  // namespace spidar::test
