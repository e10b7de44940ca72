// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The motors of a board in a port of the emulated USB, and the effect of link faults on its
/// transfers.
#pragma once

#include <array>
#include <cerrno>

#include "spidar/device.h"
#include "spidar/emulation/emulated_transport.h"
#include "spidar/protocols/bytes.h"
#include "tests/emulated_bus/bus_state.h"

namespace spidar::test {

/// Motors and encoders of a port.
class PortMotors final : public emulated::Motors {
 public:
  explicit PortMotors(UsbPort& port) : port_(port) {}
  void put_out(const std::array<int, kMaxStrings>& digits) noexcept override {
    for (size_t i = 0; i < digits.size(); ++i) port_.digit[i] = digits[i];
    ++port_.updates;
  }
  std::array<int32_t, kMaxStrings> counts() noexcept override {
    std::array<int32_t, kMaxStrings> counts{};
    for (size_t i = 0; i < counts.size(); ++i) counts[i] = port_.count[i];
    return counts;
  }
  uint16_t inputs() noexcept override { return port_.inputs; }

 private:
  UsbPort& port_;
};

/// The negative errno with which usbfs ends a transfer on such a link; 0: the transfer succeeds.
inline int status_of(LinkFault fault) {
  switch (fault) {
    case LinkFault::kStall:
      return -EPIPE;
    case LinkFault::kBusError:
      return -EPROTO;
    default:
      return 0;
  }
}

/// Changes a reply as the fault does. Returns how many bytes of it arrive.
inline size_t spoil_reply(LinkFault fault, MutableBytes reply) {
  if (fault == LinkFault::kWrongReply)
    for (size_t i = 0; i < reply.size; ++i) reply.data[i] ^= 0xA5;
  if (fault == LinkFault::kWrongEcho) reply.data[0] ^= 0x10;
  return fault == LinkFault::kShort ? reply.size / 2 : reply.size;
}

}  // namespace spidar::test
