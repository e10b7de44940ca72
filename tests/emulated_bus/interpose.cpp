// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Replaces the functions through which libusb and force feedback access the system, for files of an
// emulated bus; all other calls go to the kernel as usual. The symbols of this library precede
// those of libc and libudev when a program is linked with it or preloads it.
#undef _FILE_OFFSET_BITS  // it would rename open to open64
#undef _FORTIFY_SOURCE

#include <array>
#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <dirent.h>
#include <dlfcn.h>
#include <fcntl.h>
#include <string>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "tests/emulated_bus/bus_state.h"
#include "tests/emulated_bus/descriptors.h"
#include "tests/emulated_bus/evdev_files.h"
#include "tests/emulated_bus/exported.h"
#include "tests/emulated_bus/usb_files.h"

namespace spidar::test {
namespace {

int memory_file(const std::string& content) {
  const int file = memfd_create("sysfs", MFD_CLOEXEC);
  if (file < 0 || write(file, content.data(), content.size()) < 0) return file;
  lseek(file, 0, SEEK_SET);
  return file;
}

int no_such_file() {
  errno = ENOENT;
  return -1;
}

/// The plugged-in port with that number or address; −1 when there is none.
int port_with_address(int address) {
  for (size_t i = 0; i < kPorts; ++i) {
    const UsbPort& port = bus().port[i];
    if (port.kind != 0 && port.address == address) return static_cast<int>(i);
  }
  return -1;
}

int open_attribute(const UsbPort& port, const std::string& name) {
  const DeviceKind* const kind = kind_in(port);
  if (!kind) return no_such_file();
  if (name == "busnum" || name == "bConfigurationValue") return memory_file("1\n");
  if (name == "devnum") return memory_file(std::to_string(port.address) + "\n");
  if (name == "speed") return memory_file(kind->usb.full_speed ? "12\n" : "480\n");
  if (name == "descriptors") return memory_file(descriptors_of(*kind));
  if (name == "serial" && port.serial[0])
    return memory_file(port.serial.data() + std::string("\n"));
  return no_such_file();
}

/// Opens `path` when it belongs to the emulated bus; false when it does not.
bool open_emulated(const char* path, int& file) {
  int number = 0, address = 0;
  std::array<char, 64> attribute{};
  if (std::sscanf(path, "/dev/bus/usb/001/%d", &address) == 1) {
    const int port = port_with_address(address);
    file = port < 0 ? no_such_file() : open_usb_file(static_cast<size_t>(port));
    return true;
  }
  if (std::sscanf(path, "/sys/bus/usb/devices/1-%d/%63s", &number, attribute.data()) == 2) {
    const bool there = number >= 1 && number <= static_cast<int>(kPorts);
    file = there ? open_attribute(bus().port[static_cast<size_t>(number - 1)], attribute.data())
                 : no_such_file();
    return true;
  }
  return false;
}

int open_any(const char* path, int flags, unsigned mode) {
  int file = -1;
  return open_emulated(path, file) ? file : real_open(evdev_path(path).c_str(), flags, mode);
}

}  // namespace
}  // namespace spidar::test

using namespace spidar::test;

// Declared by hand: libc's own declarations differ in attributes between versions.
extern "C" {
BUS_API int open(const char* path, int flags, ...);
BUS_API int open64(const char* path, int flags, ...);
BUS_API int __open_2(const char* path, int flags);
BUS_API int __open64_2(const char* path, int flags);
BUS_API int ioctl(int file, unsigned long request, ...);
BUS_API int close(int file);
BUS_API int access(const char* path, int mode) noexcept;
BUS_API DIR* opendir(const char* path);
BUS_API ssize_t write(int file, const void* bytes, size_t length);

int open(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const unsigned mode = (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(arguments, unsigned) : 0;
  va_end(arguments);
  return open_any(path, flags, mode);
}

int open64(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const unsigned mode = (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(arguments, unsigned) : 0;
  va_end(arguments);
  return open_any(path, flags, mode);
}

int __open_2(const char* path, int flags) {
  return open_any(path, flags, 0);
}

int __open64_2(const char* path, int flags) {
  return open_any(path, flags, 0);
}

int ioctl(int file, unsigned long request, ...) {
  va_list arguments;
  va_start(arguments, request);
  void* argument = va_arg(arguments, void*);
  va_end(arguments);
  int result = 0;
  if (usb_ioctl(file, request, argument, result)) return result;
  if (evdev_ioctl(file, request, argument, result)) return result;
  return static_cast<int>(syscall(SYS_ioctl, file, request, argument));
}

int close(int file) {
  forget_usb_file(file);
  return static_cast<int>(syscall(SYS_close, file));
}

int access(const char* path, int mode) noexcept {
  int address = 0;
  if (std::sscanf(path, "/dev/bus/usb/001/%d", &address) != 1)
    return static_cast<int>(syscall(SYS_faccessat, AT_FDCWD, evdev_path(path).c_str(), mode));
  const int port = port_with_address(address);
  if (port >= 0 && !bus().port[static_cast<size_t>(port)].forbidden) return 0;
  errno = port < 0 ? ENOENT : EACCES;
  return -1;
}

DIR* opendir(const char* path) {
  using Opendir = DIR* (*)(const char*);
  static const auto next = reinterpret_cast<Opendir>(dlsym(RTLD_NEXT, "opendir"));
  return next(evdev_path(path).c_str());
}

ssize_t write(int file, const void* bytes, size_t length) {
  long result = 0;
  if (evdev_write_fails(file, bytes, length, result)) return result;
  if (evdev_write(file, bytes, length, result)) return result;
  return syscall(SYS_write, file, bytes, length);
}
}
