// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/boards/falcon_board.h"
#include "spidar/devices/device_kind.h"
#include "spidar/devices/device_parts.h"
#include "spidar/emulation/emulated_force_devices.h"
#include "spidar/protocols/novint_falcon.h"

namespace spidar {

DeviceKind falcon_kind() {
  DeviceKind kind;
  kind.device = "falcon";
  kind.title = "Novint Falcon";
  kind.usb = {falcon::kVendor, falcon::kProduct, {falcon::kEndpointOut, falcon::kEndpointIn}};
  kind.board = "falcon";
  kind.names = "falcon, falcon:ID";
  kind.note = "reach and scale of the force are inferred";
  kind.attach = attach<FalconBoard>;
  kind.emulate = emulate<emulated::Falcon>;
  kind.simulated_motors = simulated_hand<emulated::Falcon::kHomed>;
  return kind;
}

}  // namespace spidar
