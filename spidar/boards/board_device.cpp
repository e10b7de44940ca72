// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/boards/board_device.h"

#include <utility>

namespace spidar {

BoardDevice::BoardDevice(std::unique_ptr<Board> board, const BoardSettings& settings)
    : board_(std::move(board)), count_zero_(settings.count_zero), link_(*board_, settings) {}

void BoardDevice::open() {
  link_.open([this] {
    if (count_zero_ == CountZero::kEveryOpen || (count_zero_ != CountZero::kNever && !zeroed_))
      board_->zero_counts();
    zeroed_ = true;
    if (!board_->counts_restarted()) return;
    link_.count(LinkFault::kCounterJump);
    throw DeviceError(board_->name() +
                      ": was without power, its counters do not say any more where the grip is: "
                      "hold the grip at the centre, and stop and start again");
  });
}

}  // namespace spidar
