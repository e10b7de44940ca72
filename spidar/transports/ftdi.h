// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The parts of an FTDI serial chip that a driver needs: a few requests without data, and the
/// status bytes in front of received data.
///
/// Source: the kernel's drivers/usb/serial/ftdi_sio.h, and libnifalcon for its values.
#pragma once

#include <cstddef>
#include <cstdint>

namespace spidar {

struct VendorRequest {
  uint8_t request = 0;
  uint16_t value = 0;
};

namespace ftdi {

constexpr uint8_t kRequestType = 0x40;  ///< bmRequestType of all requests below
/// The chip puts this many bytes in front of each packet, and sends a packet of only these when its
/// latency timer ends before data was received.
constexpr size_t kStatusSize = 2;
constexpr size_t kPacketSize = 64;  ///< largest packet of a full-speed chip, bytes

constexpr uint8_t kModemControl = 1, kSetBaud = 3;
constexpr VendorRequest kDropReceived{0, 1};
constexpr VendorRequest kDropSent{0, 2};
constexpr VendorRequest kRtsLow{kModemControl, 0x0200};
constexpr VendorRequest kDtrLow{kModemControl, 0x0100};
constexpr VendorRequest kDtrHigh{kModemControl, 0x0101};
constexpr VendorRequest kNoFlowControl{2, 0};
constexpr VendorRequest kEightBits{4, 8};
/// The rate is 3 MHz divided by the value; the two highest bits are eighths.
constexpr VendorRequest baud_divisor(uint16_t value) noexcept {
  return {kSetBaud, value};
}
constexpr VendorRequest latency_ms(uint16_t value) noexcept {
  return {9, value};
}

}  // namespace ftdi
}  // namespace spidar
