// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The board in a port of the emulated USB, and the effect of link faults on its transfers.
#pragma once

#include <array>
#include <cerrno>
#include <memory>
#include <utility>

#include "spidar/device.h"
#include "spidar/emulation/emulated_boards.h"
#include "spidar/emulation/emulated_force_devices.h"
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

/// `falcon` must outlive the board.
inline std::unique_ptr<emulated::Board> make_board(UsbKind kind,
                                                   std::shared_ptr<emulated::Motors> motors,
                                                   emulated::FalconMemory& falcon) {
  if (kind == UsbKind::kFalcon)
    return std::make_unique<emulated::Falcon>(
        std::move(motors),
        std::shared_ptr<emulated::FalconMemory>(std::shared_ptr<void>(), &falcon));
  if (kind == UsbKind::kSimple) return std::make_unique<emulated::Simple>(std::move(motors));
  if (kind == UsbKind::kMouse) return std::make_unique<emulated::Mouse>(std::move(motors));
  return std::make_unique<emulated::Sh4>(std::move(motors));
}

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
