// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/emulated_bus/bus_state.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <string>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tests/emulated_bus/claim_locks.h"
#include "tests/emulated_bus/evdev_files.h"
#include "tests/emulated_bus/usb_files.h"

namespace spidar::test {
namespace {

UsbPort& plug_into(BusState& state, size_t port, UsbKind kind, const char* serial) {
  UsbPort& p = state.port[port];
  for (auto& digit : p.digit) digit = 0;
  p.fault = LinkFault::kNone;
  p.serial = {};
  std::strncpy(p.serial.data(), serial, p.serial.size() - 1);
  p.falcon.loaded = false;
  p.falcon.baud = 0;
  p.address = ++state.last_address;
  p.kind = kind;
  return p;
}

UsbKind kind_named(const std::string& name) {
  if (name == "sh4") return UsbKind::kSh4;
  if (name == "simple") return UsbKind::kSimple;
  if (name == "falcon") return UsbKind::kFalcon;
  return name == "mouse" ? UsbKind::kMouse : UsbKind::kNone;
}

EvdevKind evdev_named(const std::string& name) {
  if (name == "stick") return EvdevKind::kStick;
  if (name == "wheel") return EvdevKind::kWheel;
  return name == "pad" ? EvdevKind::kPad : EvdevKind::kNone;
}

/// New pages are filled with zeros, which is the initial value of all members of BusState.
BusState* map_state() {
  const char* named = std::getenv("SPIDAR_EMULATED_BUS");
  const UsbKind kind = kind_named(named ? named : "");
  const EvdevKind input = evdev_named(named ? named : "");
  const bool own = kind != UsbKind::kNone || input != EvdevKind::kNone;
  const char* path = own ? nullptr : named;
  const int file = path ? real_open(path, O_RDWR | O_CREAT | O_CLOEXEC, 0600) : -1;
  if (path && (file < 0 || ftruncate(file, sizeof(BusState)) != 0)) {
    std::fprintf(stderr, "emulated bus: %s: %s\n", path, std::strerror(errno));
    std::abort();
  }
  const int flags = path ? MAP_SHARED : MAP_PRIVATE | MAP_ANONYMOUS;
  void* memory = mmap(nullptr, sizeof(BusState), PROT_READ | PROT_WRITE, flags, file, 0);
  if (memory == MAP_FAILED) std::abort();
  set_lock_file(file);
  auto* state = static_cast<BusState*>(memory);
  if (kind != UsbKind::kNone) plug_into(*state, 0, kind, "");
  if (input != EvdevKind::kNone) plug_evdev_into(*state, 0, input, nullptr);
  return state;
}

}  // namespace

BusState& bus() {
  static BusState* const state = map_state();
  return *state;
}

UsbPort& plug(size_t port, UsbKind kind, const char* serial) {
  return plug_into(bus(), port, kind, serial);
}

void unplug(size_t port, int errno_first) {
  bus().port[port].kind = UsbKind::kNone;
  disconnect_files(port, errno_first);
}

void clear_bus() {
  for (size_t i = 0; i < kPorts; ++i) {
    unplug(i);
    UsbPort& port = bus().port[i];
    for (auto& digit : port.digit) digit = 0;
    for (auto& count : port.count) count = 0;
    port.inputs = 0;
    port.updates = 0;
    port.fault = LinkFault::kNone;
    port.forbidden = false;
    port.has_driver = false;
    port.halts_cleared = 0;
  }
  for (size_t i = 0; i < kEvdevPorts; ++i) unplug_evdev(i);
}

}  // namespace spidar::test
