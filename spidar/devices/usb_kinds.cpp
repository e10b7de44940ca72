// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/devices/device_folders.h"
#include "spidar/devices/device_registry.h"

namespace spidar {

// See device_registry.cpp.
#define DEVICE_FOLDER(name) std::vector<DeviceKind> name##_kinds();
SPIDAR_USB_DEVICE_FOLDERS
#undef DEVICE_FOLDER

std::vector<DeviceKind> usb_kinds() {
  std::vector<DeviceKind> kinds;
#define DEVICE_FOLDER(name) \
  for (DeviceKind & kind : name##_kinds()) kinds.push_back(kind);
  SPIDAR_USB_DEVICE_FOLDERS
#undef DEVICE_FOLDER
  return kinds;
}

}  // namespace spidar
