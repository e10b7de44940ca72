// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// USB descriptors of the emulated boards, as the kernel keeps them.
#pragma once

#include <cstdint>
#include <string>

#include "spidar/link/device_kind.h"

namespace spidar::test {

/// Device and configuration descriptor.
inline std::string descriptors_of(const DeviceKind& kind) {
  const auto& usb = kind.usb;
  const auto low = [](int v) { return static_cast<uint8_t>(v & 0xFF); };
  const auto high = [](int v) { return static_cast<uint8_t>(v >> 8); };
  const uint16_t packet = usb.full_speed ? 64 : 512;
  const bool hid = usb.interrupt;
  const uint8_t type = hid ? 3 : 2;  // interrupt, bulk
  const uint8_t interval = hid ? 1 : 0;
  const uint8_t bytes[] = {// device: USB 2.0, class by interface, packets of 64, one configuration
                           18, 1, 0x00, 0x02, 0, 0, 0, 64, low(usb.vendor), high(usb.vendor),
                           low(usb.product), high(usb.product), 0, 1, 0, 0, 3, 1,
                           // configuration: 32 bytes, one interface, bus powered, 100 mA
                           9, 2, 32, 0, 1, 1, 0, 0x80, 50,
                           // interface 0 with two endpoints: HID or vendor's own
                           9, 4, 0, 0, 2, static_cast<uint8_t>(hid ? 3 : 0xFF), 0, 0, 0,
                           // endpoints
                           7, 5, usb.out, type, low(packet), high(packet), interval, 7, 5, usb.in,
                           type, low(packet), high(packet), interval};
  return {reinterpret_cast<const char*>(bytes), sizeof bytes};
}

}  // namespace spidar::test
