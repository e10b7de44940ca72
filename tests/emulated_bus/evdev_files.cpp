// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#undef _FORTIFY_SOURCE

#include "tests/emulated_bus/evdev_files.h"

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <fcntl.h>
#include <filesystem>
#include <linux/input.h>
#include <string>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>
#include <vector>

#include "spidar/devices/force_feedback/packets.h"
#include "spidar/realtime/monotonic.h"
#include "tests/emulated_bus/bus_state.h"
#include "tests/emulated_bus/evdev_driver.h"
#include "tests/emulated_bus/evdev_kinds.h"
#include "tests/emulated_bus/evdev_port.h"
#include "tests/emulated_bus/usb_files.h"

namespace spidar::test {

namespace {

constexpr const char* kDev = "/dev/input/";
constexpr const char* kInputDevices = "/sys/class/input";

const std::string& folder();

/// Beside the file of a bus that is shared, else a folder of this process's own, which is removed
/// when it exits.
std::string make_folder() {
  const char* bus_file = std::getenv("SPIDAR_EMULATED_BUS");
  if (bus_file && std::strchr(bus_file, '/')) return std::string(bus_file) + ".input";
  std::string path = std::filesystem::temp_directory_path() / "spidar-input-XXXXXX";
  if (!mkdtemp(path.data())) std::abort();
  std::atexit([] {
    std::error_code error;
    std::filesystem::remove_all(folder(), error);
  });
  return path;
}

/// Never destroyed: a player may exit while its haptic loop still looks for the device.
const std::string& folder() {
  static const std::string& path = *new std::string(make_folder());
  return path;
}

std::string device_file(size_t number) {
  return folder() + "/dev/event" + std::to_string(number);
}
std::string sysfs_folder(size_t number) {
  return folder() + "/sys/event" + std::to_string(number);
}

/// Avoids write(), which would use the bus while it is being created.
void put_file(const std::string& path, const std::string& text) {
  const int file = real_open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  if (file < 0 || syscall(SYS_write, file, text.data(), text.size()) < 0) std::abort();
  syscall(SYS_close, file);
}

std::string hex(uint16_t id) {
  std::array<char, 8> text{};
  std::snprintf(text.data(), text.size(), "%04x\n", static_cast<unsigned>(id));
  return text.data();
}

void unplug_from(BusState& state, size_t number) {
  EvdevPort& port = state.evdev[number];
  port.kind = EvdevKind::kNone;
  erase_effects(port);
  std::error_code error;
  std::filesystem::remove(device_file(number), error);
  std::filesystem::remove_all(sysfs_folder(number), error);
}

/// The port of that file; nullptr and `is_evdev` when it was unplugged.
EvdevPort* port_of(int file, bool& is_evdev) {
  struct stat status {};
  is_evdev = false;
  if (fstat(file, &status) != 0 || !S_ISREG(status.st_mode)) return nullptr;
  for (EvdevPort& port : bus().evdev) {
    if (port.kind == EvdevKind::kNone || port.inode != status.st_ino) continue;
    is_evdev = true;
    return &port;
  }
  if (status.st_nlink > 0) return nullptr;
  // The file of a device that was pulled out.
  std::array<char, 512> target{};
  const std::string link = "/proc/self/fd/" + std::to_string(file);
  if (readlink(link.c_str(), target.data(), target.size() - 1) > 0)
    is_evdev = std::strncmp(target.data(), folder().c_str(), folder().size()) == 0;
  return nullptr;
}

/// Like the kernel when the last process closes the device.
void erase_if_abandoned(EvdevPort& port) {
  const auto number = static_cast<size_t>(&port - bus().evdev.data());
  const int file = real_open(device_file(number).c_str(), O_RDWR | O_CLOEXEC, 0);
  const bool abandoned = file >= 0 && flock(file, LOCK_EX | LOCK_NB) == 0;
  if (abandoned) erase_effects(port);
  if (file >= 0) syscall(SYS_close, file);
}

}  // namespace

std::string evdev_path(const char* path) {
  const auto begins = [path](const char* with) {
    return std::strncmp(path, with, std::strlen(with)) == 0;
  };
  if (!begins(kDev) && !begins(kInputDevices)) return path;
  bus();  // what $SPIDAR_EMULATED_BUS plugs in
  if (begins(kDev)) return folder() + "/dev/" + (path + std::strlen(kDev));
  return folder() + "/sys" + (path + std::strlen(kInputDevices));
}

bool evdev_ioctl(int file, unsigned long request, void* argument, int& result) {
  if (_IOC_TYPE(request) != 'E') return false;
  bool is_evdev = false;
  EvdevPort* port = port_of(file, is_evdev);
  if (!is_evdev) return false;
  result = -ENODEV;
  if (port) {
    // The first call of a program, before it locks the device.
    if (request == EVIOCGVERSION) erase_if_abandoned(*port);
    result = EvdevDriver{*port}.call(request, argument);
  }
  if (result >= 0) return true;
  errno = -result;
  result = -1;
  return true;
}

bool evdev_write_fails(int file, const void* bytes, size_t length, long& result) {
  if (!ff::decode_event({static_cast<const uint8_t*>(bytes), length})) return false;
  bool is_evdev = false;
  const EvdevPort* port = port_of(file, is_evdev);
  return port && EvdevDriver::write_fails(*port, length, result);
}

bool evdev_write(int file, const void* bytes, size_t length, long& result) {
  const auto event = ff::decode_event({static_cast<const uint8_t*>(bytes), length});
  if (!event) return false;  // by far the most frequent case
  bool is_evdev = false;
  EvdevPort* port = port_of(file, is_evdev);
  if (!is_evdev) return false;
  const int error = port ? EvdevDriver{*port}.event(*event) : -ENODEV;
  result = static_cast<long>(length);
  if (error >= 0) return true;
  errno = -error;
  result = -1;
  return true;
}

EvdevPort& plug_evdev_into(BusState& state, size_t number, EvdevKind kind, const char* driver,
                           const EvdevIdentity& identity) {
  unplug_from(state, number);
  EvdevPort& port = state.evdev[number];
  reset(port);
  const std::string place =
      identity.place ? identity.place : "usb-emulated-" + std::to_string(number) + "/input0";
  const auto keep = [](auto& into, const std::string& text) {
    std::snprintf(into.data(), into.size(), "%s", text.c_str());
  };
  keep(port.place, place);
  keep(port.serial, identity.serial);
  keep(port.name, identity.name ? identity.name : name_of(kind));
  const std::string driven_by = driver ? driver : driver_of(kind);
  // hid-pidff starts with the centring spring at its full strength.
  if (driven_by == "hid-generic" || driven_by == "hid-universal-pidff") port.autocentre = 0xFFFF;
  const std::string sysfs = sysfs_folder(number) + "/device";
  std::filesystem::create_directories(folder() + "/dev");
  std::filesystem::create_directories(sysfs + "/capabilities");
  std::filesystem::create_directories(sysfs + "/id");
  std::filesystem::create_directories(sysfs + "/device");
  // As of a device on the HID bus.
  put_file(sysfs + "/device/uevent",
           "DRIVER=" + driven_by + "\nHID_ID=0003:00001209:00000001\nMODALIAS=hid:b0003g0001\n");
  put_file(sysfs + "/capabilities/ff", sysfs_bits(ff_bits(kind)));
  put_file(sysfs + "/name", std::string(port.name.data()) + "\n");
  put_file(sysfs + "/uniq", std::string(identity.serial) + "\n");
  put_file(sysfs + "/phys", place + "\n");
  const UsbId id = usb_id_of(kind);
  put_file(sysfs + "/id/vendor", hex(id.vendor));
  put_file(sysfs + "/id/product", hex(id.product));
  put_file(device_file(number), "");
  struct stat status {};
  if (stat(device_file(number).c_str(), &status) != 0) std::abort();
  port.inode = status.st_ino;
  port.kind = kind;
  return port;
}

EvdevPort& plug_evdev(size_t number, EvdevKind kind, const char* driver,
                      const EvdevIdentity& identity) {
  return plug_evdev_into(bus(), number, kind, driver, identity);
}

void unplug_evdev(size_t number) {
  unplug_from(bus(), number);
}

EvdevLevels evdev_levels(size_t number) {
  EvdevPort& port = bus().evdev[number];
  erase_if_abandoned(port);
  EvdevLevels levels;
  for (const EvdevPort::Effect& effect : port.effect) {
    if (!is_playing(port, effect)) continue;
    levels.right += effect.right;
    levels.up += effect.up;
    levels.rumble += effect.rumble;
  }
  return levels;
}

}  // namespace spidar::test
