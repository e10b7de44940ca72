#include "tests/emulated_bus/bus_state.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <new>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tests/emulated_bus/usb_files.h"

namespace spidar::test {
namespace {

/// Fresh pages are zeros, which is how all of BusState begins.
BusState* map_state() {
  const char* path = std::getenv("SPIDAR_EMULATED_BUS");
  const int file = path ? real_open(path, O_RDWR | O_CREAT | O_CLOEXEC, 0600) : -1;
  if (path && (file < 0 || ftruncate(file, sizeof(BusState)) != 0)) {
    std::fprintf(stderr, "emulated bus: %s: %s\n", path, std::strerror(errno));
    std::abort();
  }
  const int flags = path ? MAP_SHARED : MAP_PRIVATE | MAP_ANONYMOUS;
  void* memory = mmap(nullptr, sizeof(BusState), PROT_READ | PROT_WRITE, flags, file, 0);
  if (memory == MAP_FAILED) std::abort();
  set_lock_file(file);
  return static_cast<BusState*>(memory);
}

}  // namespace

BusState& bus() {
  static BusState* const state = map_state();
  return *state;
}

UsbPort& plug(size_t port, UsbKind kind, const char* serial) {
  UsbPort& p = bus().port[port];
  for (auto& digit : p.digit) digit = 0;
  p.fault = LinkFault::kNone;
  p.serial = {};
  std::strncpy(p.serial.data(), serial, p.serial.size() - 1);
  p.address = ++bus().last_address;
  p.kind = kind;
  return p;
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
}

}  // namespace spidar::test
