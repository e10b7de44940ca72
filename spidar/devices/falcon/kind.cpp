// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/devices/falcon/board.h"
#include "spidar/devices/falcon/emulated.h"
#include "spidar/devices/falcon/packets.h"
#include "spidar/link/device_kind.h"
#include "spidar/link/device_parts.h"
#include "spidar/link/spring_hand.h"

namespace spidar {

std::vector<DeviceKind> falcon_kinds() {
  DeviceKind kind;
  kind.device = "falcon";
  kind.title = "Novint Falcon";
  kind.usb = {falcon::kVendor, falcon::kProduct, falcon::kEndpointOut, falcon::kEndpointIn};
  kind.usb.full_speed = true;
  kind.board = "falcon";
  kind.names = "falcon, falcon:ID";
  kind.chosen_as = "a Novint Falcon";
  kind.note = "reach and scale of the force are inferred";
  kind.attach = attach<boards::Falcon>;
  kind.emulate = emulate<emulated::Falcon>;
  kind.hand = emulated::spring_hand<emulated::Falcon::kHomed>;
  return {kind};
}

}  // namespace spidar
