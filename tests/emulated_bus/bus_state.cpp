// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/emulated_bus/bus_state.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <stdexcept>
#include <string>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#include <vector>

#include "spidar/devices/device_registry.h"
#include "tests/emulated_bus/claim_locks.h"
#include "tests/emulated_bus/evdev_files.h"
#include "tests/emulated_bus/usb_files.h"

namespace spidar::test {
namespace {

/// Never destroyed: a player may exit while its haptic loop still looks for the device.
const std::vector<DeviceKind>& kinds() {
  static const auto& it = *new std::vector<DeviceKind>(usb_kinds());
  return it;
}

UsbPort& plug_into(BusState& state, size_t port, size_t kind, const char* serial) {
  UsbPort& p = state.port[port];
  for (auto& digit : p.digit) digit = 0;
  p.fault = LinkFault::kNone;
  p.serial = {};
  std::strncpy(p.serial.data(), serial, p.serial.size() - 1);
  p.memory.loaded = false;
  p.memory.baud = 0;
  p.address = ++state.last_address;
  p.kind = kind;
  return p;
}

/// UsbPort::kind of this DeviceKind::board; 0 if there is none.
size_t kind_named(std::string_view board) {
  for (size_t i = 0; i < kinds().size(); ++i)
    if (board == kinds()[i].board) return i + 1;
  return 0;
}

EvdevKind evdev_named(const std::string& name) {
  if (name == "stick") return EvdevKind::kStick;
  if (name == "wheel") return EvdevKind::kWheel;
  return name == "pad" ? EvdevKind::kPad : EvdevKind::kNone;
}

/// New pages are filled with zeros, which is the initial value of all members of BusState.
BusState* map_state() {
  const char* named = std::getenv("SPIDAR_EMULATED_BUS");
  const size_t kind = kind_named(named ? named : "");
  const EvdevKind input = evdev_named(named ? named : "");
  const bool own = kind != 0 || input != EvdevKind::kNone;
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
  if (kind != 0) plug_into(*state, 0, kind, "");
  if (input != EvdevKind::kNone) plug_evdev_into(*state, 0, input, nullptr);
  return state;
}

}  // namespace

BusState& bus() {
  static BusState* const state = map_state();
  return *state;
}

UsbPort& plug(size_t port, std::string_view board, const char* serial) {
  const size_t kind = kind_named(board);
  if (kind == 0)
    throw std::invalid_argument("no board on USB is called \"" + std::string(board) + "\"");
  return plug_into(bus(), port, kind, serial);
}

const DeviceKind* kind_in(const UsbPort& port) {
  const size_t kind = port.kind;
  return kind == 0 ? nullptr : &kinds()[kind - 1];
}

void unplug(size_t port, int errno_first) {
  bus().port[port].kind = 0;
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
