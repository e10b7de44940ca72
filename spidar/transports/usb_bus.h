// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Lists USB devices, with libusb and a separate context.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

struct libusb_context;

namespace spidar {

/// A device in the list of the bus; it is not opened.
struct UsbDeviceInfo {
  uint16_t vendor = 0;
  uint16_t product = 0;
  int bus = 0;
  int address = 0;          ///< changes each time the device is plugged in
  std::string path;         ///< the port: "1-2.3"
  std::string serial;       ///< printable(); empty if it has none
  bool accessible = false;  ///< this process may write to it

  /// "/dev/bus/usb/001/004"
  std::string device_file() const;
};

struct UsbContextCloser {
  void operator()(libusb_context* context) const noexcept;
};
using UsbContext = std::unique_ptr<libusb_context, UsbContextCloser>;

/// A new context scans the bus again, so that devices are found even if udev does not announce
/// them. Throws DeviceError.
UsbContext make_usb_context();

/// Returns the devices with `vendor` and `product`. Reads descriptors that the system has stored;
/// nothing is sent to a device. Throws DeviceError when there is no access to the bus.
std::vector<UsbDeviceInfo> list_usb_devices(uint16_t vendor, uint16_t product);

}  // namespace spidar
