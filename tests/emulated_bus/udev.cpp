// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The parts of libudev that libusb uses; it lists the emulated bus. There are no events: to see
// devices that were plugged in later, list again in a new context, as on a machine without udevd.
#include <array>
#include <cstring>
#include <string>
#include <sys/eventfd.h>
#include <unistd.h>
#include <vector>

#include "tests/emulated_bus/bus_state.h"
#include "tests/emulated_bus/exported.h"

using namespace spidar::test;

// As opaque to libusb as the real ones.
struct udev {};
struct udev_monitor {
  int file = -1;
};
struct udev_list_entry {
  std::string syspath;
  udev_list_entry* next = nullptr;
};
struct udev_enumerate {
  std::vector<udev_list_entry> entries;
};
struct udev_device {
  std::string name;
  std::string node;
};

namespace {

// Not a std::string: a player may exit while its haptic loop still looks for the device.
constexpr const char* kUsbDevices = "/sys/bus/usb/devices/";

udev_device* device_in(size_t port) {
  std::array<char, 32> node{};
  snprintf(node.data(), node.size(), "/dev/bus/usb/001/%03d", bus().port[port].address.load());
  return new udev_device{"1-" + std::to_string(port + 1), node.data()};
}

}  // namespace

extern "C" {

BUS_API udev* udev_new() {
  return new udev;
}
BUS_API udev* udev_unref(udev* u) {
  delete u;
  return nullptr;
}

BUS_API udev_monitor* udev_monitor_new_from_netlink(udev*, const char*) {
  return new udev_monitor{eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)};
}
BUS_API int udev_monitor_filter_add_match_subsystem_devtype(udev_monitor*, const char*,
                                                            const char*) {
  return 0;
}
BUS_API int udev_monitor_enable_receiving(udev_monitor*) {
  return 0;
}
BUS_API int udev_monitor_get_fd(udev_monitor* monitor) {
  return monitor->file;
}
BUS_API udev_device* udev_monitor_receive_device(udev_monitor*) {
  return nullptr;
}
BUS_API udev_monitor* udev_monitor_unref(udev_monitor* monitor) {
  close(monitor->file);
  delete monitor;
  return nullptr;
}

BUS_API udev_enumerate* udev_enumerate_new(udev*) {
  return new udev_enumerate;
}
BUS_API int udev_enumerate_add_match_subsystem(udev_enumerate*, const char*) {
  return 0;
}
BUS_API int udev_enumerate_add_match_property(udev_enumerate*, const char*, const char*) {
  return 0;
}
BUS_API int udev_enumerate_scan_devices(udev_enumerate* list) {
  for (size_t i = 0; i < kPorts; ++i)
    if (bus().port[i].kind != 0)
      list->entries.push_back({kUsbDevices + ("1-" + std::to_string(i + 1)), nullptr});
  for (size_t i = 0; i + 1 < list->entries.size(); ++i)
    list->entries[i].next = &list->entries[i + 1];
  return 0;
}
BUS_API udev_list_entry* udev_enumerate_get_list_entry(udev_enumerate* list) {
  return list->entries.empty() ? nullptr : list->entries.data();
}
BUS_API udev_enumerate* udev_enumerate_unref(udev_enumerate* list) {
  delete list;
  return nullptr;
}
BUS_API udev_list_entry* udev_list_entry_get_next(udev_list_entry* entry) {
  return entry->next;
}
BUS_API const char* udev_list_entry_get_name(udev_list_entry* entry) {
  return entry->syspath.c_str();
}

BUS_API udev_device* udev_device_new_from_syspath(udev*, const char* path) {
  for (size_t i = 0; i < kPorts; ++i)
    if (path == kUsbDevices + ("1-" + std::to_string(i + 1)) && bus().port[i].kind != 0)
      return device_in(i);
  return nullptr;
}
BUS_API const char* udev_device_get_devnode(udev_device* device) {
  return device->node.c_str();
}
BUS_API const char* udev_device_get_sysname(udev_device* device) {
  return device->name.c_str();
}
BUS_API const char* udev_device_get_action(udev_device*) {
  return "add";
}
BUS_API udev_device* udev_device_unref(udev_device* device) {
  delete device;
  return nullptr;
}
}
