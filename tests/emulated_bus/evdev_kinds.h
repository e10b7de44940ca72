// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Capabilities of each kind of emulated input device, as the kernel reports them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/emulated_bus/evdev_port.h"

namespace spidar::test {

/// Whether it has forces with a direction; otherwise it only rumbles.
bool is_constant(EvdevKind kind);

/// Codes of EV_FF and of EV_ABS that the device has.
std::vector<unsigned> ff_bits(EvdevKind kind);
std::vector<unsigned> abs_bits(EvdevKind kind);
/// Buttons, of EV_KEY.
std::vector<unsigned> key_bits(EvdevKind kind);

const char* name_of(EvdevKind kind);

struct UsbId {
  uint16_t vendor = 0;
  uint16_t product = 0;
};
UsbId usb_id_of(EvdevKind kind);

/// Kernel driver that such a device usually has.
const char* driver_of(EvdevKind kind);

/// As the kernel prints them in sysfs: words, the highest first.
std::string sysfs_bits(const std::vector<unsigned>& bits);

/// As EVIOCGBIT writes them, into `size` bytes. Returns `size`.
int put_bits(const std::vector<unsigned>& bits, void* argument, size_t size);

}  // namespace spidar::test
