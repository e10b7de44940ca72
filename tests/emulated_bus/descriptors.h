// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// USB descriptors of the emulated boards, as the kernel keeps them.
#pragma once

#include <cstdint>
#include <string>

#include "tests/emulated_bus/bus_state.h"

namespace spidar::test {

/// Device and configuration descriptor.
inline std::string descriptors_of(UsbKind kind) {
  const bool mouse = kind == UsbKind::kMouse, falcon = kind == UsbKind::kFalcon;
  const uint16_t vendor = mouse ? 0x04D8 : falcon ? 0x0403 : 0x0CEC;
  const uint16_t product = mouse                      ? 0x003F
                           : falcon                   ? 0xCB48
                           : kind == UsbKind::kSimple ? 0x0203
                                                      : 0x0205;
  const auto low = [](uint16_t v) { return static_cast<uint8_t>(v & 0xFF); };
  const auto high = [](uint16_t v) { return static_cast<uint8_t>(v >> 8); };
  const uint16_t packet = mouse || falcon ? 64 : 512;
  const uint8_t type = mouse ? 3 : 2;  // interrupt, bulk
  const uint8_t interval = mouse ? 1 : 0;
  const uint8_t out = mouse ? 0x01 : 0x02;
  const uint8_t in = mouse || falcon ? 0x81 : 0x86;
  const uint8_t bytes[] = {// device: USB 2.0, class by interface, packets of 64, one configuration
                           18, 1, 0x00, 0x02, 0, 0, 0, 64, low(vendor), high(vendor), low(product),
                           high(product), 0, 1, 0, 0, 3, 1,
                           // configuration: 32 bytes, one interface, bus powered, 100 mA
                           9, 2, 32, 0, 1, 1, 0, 0x80, 50,
                           // interface 0 with two endpoints: HID or vendor's own
                           9, 4, 0, 0, 2, static_cast<uint8_t>(mouse ? 3 : 0xFF), 0, 0, 0,
                           // endpoints
                           7, 5, out, type, low(packet), high(packet), interval, 7, 5, in, type,
                           low(packet), high(packet), interval};
  return {reinterpret_cast<const char*>(bytes), sizeof bytes};
}

}  // namespace spidar::test
