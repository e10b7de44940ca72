// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/boards/usb_mouse.h"

#include <utility>

namespace spidar {
namespace {

std::unique_ptr<UsbTransport> transport_of(UsbFamily family, const std::string& name) {
  for (const UsbBoardKind& kind : usb_kinds())
    if (kind.family == family) return std::make_unique<UsbTransport>(name, kind.pipes);
  throw DeviceError(name + ": no USB device of this family is known");
}

}  // namespace

UsbMouse::UsbMouse(const std::string& name, const std::string& id)
    : UsbMouse(name, id, transport_of(UsbFamily::kMouse, name)) {}

UsbMouse::UsbMouse(const std::string& name, const std::string& id,
                   std::unique_ptr<UsbTransport> transport)
    : search_(UsbFamily::kMouse, name, id),
      transport_(*transport),
      mouse_(name, std::move(transport)) {}

void UsbMouse::open() {
  close();
  search_.open(
      [this](const UsbSearch::Candidate& candidate) {
        transport_.select(candidate.device);
        mouse_.open();
        path_ = candidate.device.path;
        return -1;  // it has no rotary switch
      },
      [this] { close(); });
}

}  // namespace spidar
