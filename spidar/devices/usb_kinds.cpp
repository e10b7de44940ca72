// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/devices/device_registry.h"
#include "spidar/devices/rooms.h"

namespace spidar {

// See device_registry.cpp.
#define ROOM(name) std::vector<DeviceKind> name##_kinds();
SPIDAR_USB_ROOMS
#undef ROOM

std::vector<DeviceKind> usb_kinds() {
  std::vector<DeviceKind> kinds;
#define ROOM(name) \
  for (DeviceKind & kind : name##_kinds()) kinds.push_back(kind);
  SPIDAR_USB_ROOMS
#undef ROOM
  return kinds;
}

}  // namespace spidar
