// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/boards/mouse_board.h"

#include <utility>

#include "spidar/boards/board_parts.h"

namespace spidar {

MouseBoard::MouseBoard(std::string name, std::unique_ptr<Transport> transport)
    : name_(std::move(name)), transport_(std::move(transport)) {}

void MouseBoard::open() {
  transport_->open();
  mouse::encode_query(out_);
  const LinkFault fault = open_exchange(
      [&](int64_t deadline_ns) {
        const Transfer transfer = transport_->exchange({out_}, in_, deadline_ns);
        if (transfer.fault != LinkFault::kNone) return transfer.fault;
        return mouse::is_state({in_.data(), transfer.received}) ? LinkFault::kNone
                                                                : LinkFault::kWrongReply;
      },
      *transport_);
  if (fault != LinkFault::kNone) {
    transport_->close();
    throw DeviceError(name_ +
                      ": the device with the id 04d8:003f is no SPIDAR-mouse: asked for its "
                      "state, the answer is " +
                      to_string(fault) + "; that id is shared by many devices, unplug others");
  }
  mouse::encode_start(out_);
  transport_->exchange({out_}, {}, soon_ns());
  started_ = true;
  cycle_ = 0;
}

void MouseBoard::close() noexcept {
  if (started_) {
    const int64_t deadline_ns = soon_ns();
    mouse::encode_force({}, out_);
    transport_->exchange({out_}, {}, deadline_ns);
    mouse::encode_stop(out_);
    transport_->exchange({out_}, {}, deadline_ns);
    started_ = false;
  }
  transport_->close();
}

LinkFault MouseBoard::cycle(const ForceOutput& output, ForceReading& reading,
                            int64_t deadline_ns) noexcept {
  if (cycle_++ % kCyclesPerReport == 0) {
    mouse::encode_force({output.force_N.x(), output.force_N.y()}, out_);
    const Transfer transfer = transport_->exchange({out_}, {}, deadline_ns);
    if (transfer.fault != LinkFault::kNone) return transfer.fault;
  }
  reading.position_m.setZero();
  return LinkFault::kNone;
}

std::vector<LastWill> MouseBoard::last_wills() const {
  mouse::Report zero, stop;
  mouse::encode_force({}, zero);
  mouse::encode_stop(stop);
  return wills(*transport_, {zero, stop});
}

}  // namespace spidar
