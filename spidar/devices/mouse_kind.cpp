// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/boards/mouse_board.h"
#include "spidar/devices/device_kind.h"
#include "spidar/devices/device_parts.h"
#include "spidar/emulation/emulated_boards.h"
#include "spidar/protocols/spidar_mouse.h"

namespace spidar {

DeviceKind mouse_kind() {
  DeviceKind kind;
  kind.device = "mouse";
  kind.title = "SPIDAR-mouse";
  kind.usb = {
      mouse::kVendor, mouse::kProduct, {mouse::kEndpointOut, mouse::kEndpointIn, true}, true};
  kind.board = "mouse";
  kind.names = "mouse, mouse:ID";
  kind.verification = Verification::kInferred;
  kind.note = "other devices have this id; asked when it is opened";
  kind.attach = attach<MouseBoard>;
  kind.emulate = emulate<emulated::Mouse>;
  kind.simulated_motors = unconnected_motors;
  return kind;
}

}  // namespace spidar
