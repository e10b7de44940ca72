// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What is on the USB, by libusb, and a context of its own.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/api.h"

struct libusb_context;

namespace spidar {

/// A device as the bus lists it; nothing is opened.
struct UsbDeviceInfo {
  uint16_t vendor = 0;
  uint16_t product = 0;
  int bus = 0;
  int address = 0;          ///< of this time it was plugged in
  std::string path;         ///< where it is plugged in: "1-2.3"
  std::string serial;       ///< empty when it has none
  bool accessible = false;  ///< this process may write to it

  /// "/dev/bus/usb/001/004"
  SPIDAR_API std::string device_file() const;
};

struct UsbContextCloser {
  void operator()(libusb_context* context) const noexcept;
};
using UsbContext = std::unique_ptr<libusb_context, UsbContextCloser>;

/// A fresh one scans the bus anew, so that devices are found again where no udev tells of them.
/// Throws DeviceError.
UsbContext make_usb_context();

/// Devices whose vendor and product are `vendor`, `product`. Reads descriptors that the system
/// keeps; nothing is sent to a device. Throws DeviceError when there is no access to the bus.
SPIDAR_API std::vector<UsbDeviceInfo> list_usb_devices(uint16_t vendor, uint16_t product);

}  // namespace spidar
