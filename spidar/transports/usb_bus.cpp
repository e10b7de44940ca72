// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/transports/usb_bus.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <fcntl.h>
#include <string_view>
#include <unistd.h>

#include <libusb.h>

#include "spidar/device.h"
#include "spidar/printable.h"

namespace spidar {
namespace {

std::string bus_path(libusb_device* device) {
  std::array<uint8_t, 7> ports{};  // the deepest tree that USB allows
  const int depth = libusb_get_port_numbers(device, ports.data(), static_cast<int>(ports.size()));
  std::string path = std::to_string(libusb_get_bus_number(device));
  for (int i = 0; i < depth; ++i)
    path += (i == 0 ? '-' : '.') + std::to_string(ports[static_cast<size_t>(i)]);
  return path;
}

/// The serial number as the kernel read it when the device was plugged in; reading it from the
/// device requires opening it.
std::string kernel_serial(const std::string& path) {
  const int file = open(("/sys/bus/usb/devices/" + path + "/serial").c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return {};
  std::array<char, 256> text{};
  const ssize_t length = read(file, text.data(), text.size());
  close(file);
  const std::string_view serial(text.data(), length > 0 ? static_cast<size_t>(length) : 0);
  return printable(serial.substr(0, serial.find('\n')));
}

}  // namespace

std::string UsbDeviceInfo::device_file() const {
  std::array<char, 64> name{};
  std::snprintf(name.data(), name.size(), "/dev/bus/usb/%03d/%03d", bus, address);
  return name.data();
}

void UsbContextCloser::operator()(libusb_context* context) const noexcept {
  libusb_exit(context);
}

UsbContext make_usb_context() {
  libusb_context* context = nullptr;
  const int error = libusb_init(&context);
  if (error != LIBUSB_SUCCESS)
    throw DeviceError(std::string("usb: cannot be used: ") + libusb_strerror(error) +
                          "; is there a USB on this machine (/dev/bus/usb)?",
                      DeviceErrorCode::kAbsent);
  return UsbContext(context);
}

std::vector<UsbDeviceInfo> list_usb_devices(uint16_t vendor, uint16_t product) {
  const UsbContext context = make_usb_context();
  libusb_device** list = nullptr;
  const ssize_t count = libusb_get_device_list(context.get(), &list);
  std::vector<UsbDeviceInfo> found;
  for (ssize_t i = 0; i < count; ++i) {
    libusb_device_descriptor descriptor{};
    if (libusb_get_device_descriptor(list[i], &descriptor) != LIBUSB_SUCCESS ||
        descriptor.idVendor != vendor || descriptor.idProduct != product)
      continue;
    UsbDeviceInfo info{vendor,
                       product,
                       libusb_get_bus_number(list[i]),
                       libusb_get_device_address(list[i]),
                       bus_path(list[i]),
                       {},
                       false};
    info.serial = kernel_serial(info.path);
    info.accessible = access(info.device_file().c_str(), W_OK) == 0;
    found.push_back(std::move(info));
  }
  if (list) libusb_free_device_list(list, 1);
  std::sort(found.begin(), found.end(),
            [](const UsbDeviceInfo& a, const UsbDeviceInfo& b) { return a.path < b.path; });
  return found;
}

}  // namespace spidar
