// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/devices/mouse/board.h"
#include "spidar/devices/mouse/emulated.h"
#include "spidar/devices/mouse/packets.h"
#include "spidar/link/device_kind.h"
#include "spidar/link/device_parts.h"

namespace spidar {

std::vector<DeviceKind> mouse_kinds() {
  DeviceKind kind;
  kind.device = "mouse";
  kind.title = "SPIDAR-mouse";
  kind.usb = {mouse::kVendor, mouse::kProduct, mouse::kEndpointOut, mouse::kEndpointIn, true};
  kind.usb.shared = kind.usb.full_speed = true;
  kind.board = "mouse";
  kind.names = "mouse, mouse:ID";
  kind.evidence = "inferred";
  kind.note = "other devices have this id: it is asked when it is opened";
  kind.attach = attach<boards::Mouse>;
  kind.emulate = emulate<emulated::Mouse>;
  return {kind};
}

}  // namespace spidar
