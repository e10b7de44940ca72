// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/link/device_kind.h"

namespace spidar {

std::vector<DeviceKind> usb_kinds() {
  std::vector<DeviceKind> kinds;
  for (const auto& of_room : {cyverse_kinds, falcon_kinds, mouse_kinds}) {
    for (DeviceKind& kind : of_room()) kinds.push_back(kind);
  }
  return kinds;
}

}  // namespace spidar
