// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/boards/usb_force_board.h"

#include <utility>

namespace spidar {

UsbForceBoard::UsbForceBoard(UsbFamily family, const std::string& name, const std::string& id)
    : search_(family, name, id) {
  for (const UsbBoardKind& kind : usb_kinds()) {
    if (kind.family != family || kind.make_force == nullptr) continue;
    auto transport = std::make_unique<UsbTransport>(name, kind.pipes);
    transport_ = transport.get();
    board_ = kind.make_force(name, std::move(transport));
  }
  if (!board_) throw DeviceError(name + ": no USB device of this family takes a force");
}

void UsbForceBoard::open() {
  close();
  search_.open(
      [this](const UsbSearch::Candidate& candidate) {
        transport_->select(candidate.device);
        board_->open();
        path_ = candidate.device.path;
        return -1;  // it has no rotary switch
      },
      [this] { close(); });
}

}  // namespace spidar
