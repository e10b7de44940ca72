// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The bus for tests in Python, which preload this library and call it through ctypes
// (pipelines/bus_case.py).
#include <algorithm>
#include <cstdint>

#include "tests/emulated_bus/bus_state.h"
#include "tests/emulated_bus/exported.h"

using namespace spidar::test;

extern "C" {

BUS_API void bus_plug(int port, const char* board) {
  plug(static_cast<size_t>(port), board);
}
BUS_API void bus_plug_named(int port, const char* board, const char* serial) {
  plug(static_cast<size_t>(port), board, serial);
}
/// Whether open() gives EACCES.
BUS_API void bus_forbid(int port, bool forbidden) {
  bus().port[static_cast<size_t>(port)].forbidden = forbidden;
}
BUS_API void bus_unplug(int port, int errno_first) {
  unplug(static_cast<size_t>(port), errno_first);
}
BUS_API void bus_clear() {
  clear_bus();
}
BUS_API bool bus_at_rest(int port) {
  return bus().port[static_cast<size_t>(port)].at_rest();
}
BUS_API uint64_t bus_updates(int port) {
  return bus().port[static_cast<size_t>(port)].updates;
}
BUS_API void bus_move(int port, int counts) {
  for (auto& count : bus().port[static_cast<size_t>(port)].count) count += counts;
}
BUS_API uint64_t bus_files_opened() {
  return bus().files_opened;
}

BUS_API void evdev_plug(int number, int kind) {
  plug_evdev(static_cast<size_t>(number), static_cast<EvdevKind>(kind));
}
/// In a place that another number may get later.
BUS_API void evdev_plug_at(int number, int kind, const char* place) {
  plug_evdev(static_cast<size_t>(number), static_cast<EvdevKind>(kind), nullptr, {"", place});
}
BUS_API void evdev_unplug(int number) {
  unplug_evdev(static_cast<size_t>(number));
}
BUS_API bool evdev_at_rest(int number) {
  return evdev_levels(static_cast<size_t>(number)).at_rest();
}
BUS_API bool evdev_plays(int number) {
  evdev_levels(static_cast<size_t>(number));  // erases the effects of a player that has closed it
  const auto& effects = bus().evdev[static_cast<size_t>(number)].effect;
  return std::any_of(effects.begin(), effects.end(),
                     [](const EvdevPort::Effect& effect) { return effect.plays.load(); });
}
BUS_API void evdev_hang(int number, bool hangs) {
  bus().evdev[static_cast<size_t>(number)].hangs = hangs;
}
BUS_API int evdev_hanging(int number) {
  return bus().evdev[static_cast<size_t>(number)].hanging;
}
BUS_API uint64_t evdev_uploads(int number) {
  return bus().evdev[static_cast<size_t>(number)].uploads;
}

}  // extern "C"
