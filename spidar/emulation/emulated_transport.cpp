// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/emulation/emulated_transport.h"

#include <utility>

#include "spidar/device.h"

namespace spidar {

EmulatedTransport::EmulatedTransport(std::unique_ptr<EmulatedBoard> board,
                                     std::shared_ptr<EmulatedWire> wire)
    : board_(std::move(board)), wire_(std::move(wire)) {}

void EmulatedTransport::open() {
  if (wire_->fault == LinkFault::kGone) throw DeviceError("emulated board: not plugged in");
  open_ = true;
}

Transfer EmulatedTransport::exchange(std::initializer_list<ByteView> packets, MutableBytes reply,
                                     int64_t) noexcept {
  const LinkFault fault = wire_->fault.load(std::memory_order_relaxed);
  // A device that was pulled out must be opened again.
  if (fault == LinkFault::kGone) open_ = false;
  if (!open_) return {LinkFault::kGone, 0};
  if (fault == LinkFault::kStall) return {fault, 0};
  for (const ByteView packet : packets) board_->receive(packet);
  if (reply.size == 0) return {};
  const size_t received = board_->reply(reply);
  switch (fault) {
    case LinkFault::kNone:
      break;
    case LinkFault::kShort:
      return {fault, received / 2};
    case LinkFault::kWrongReply:
      for (size_t i = 0; i < received; ++i) reply.data[i] ^= 0xA5;
      return {LinkFault::kNone, received};
    default:
      return {fault, 0};
  }
  if (received == 0) return {LinkFault::kTimeout, 0};
  return {received < reply.size ? LinkFault::kShort : LinkFault::kNone, received};
}

LinkFault EmulatedTransport::control(const VendorRequest& request, int64_t) noexcept {
  const LinkFault fault = wire_->fault.load(std::memory_order_relaxed);
  if (fault == LinkFault::kGone) open_ = false;
  if (!open_) return LinkFault::kGone;
  if (fault == LinkFault::kStall || fault == LinkFault::kTimeout) return fault;
  return board_->control(request) ? LinkFault::kNone : LinkFault::kStall;
}

void EmulatedTransport::recover() noexcept {
  std::array<uint8_t, 512> old{};
  while (board_->reply(old) > 0) {
  }
}

}  // namespace spidar
