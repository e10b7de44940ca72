// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Files of the emulated input devices. They are real files in a folder of the emulated bus, so
/// that they can be listed, locked and passed on to another process; calls are answered here.
#pragma once

#include <cstddef>
#include <string>

#include "tests/emulated_bus/evdev_port.h"

namespace spidar::test {

struct BusState;

/// plug_evdev() for use while the bus is being created.
EvdevPort& plug_evdev_into(BusState& state, size_t number, EvdevKind kind, const char* driver,
                           const EvdevIdentity& identity = {});

/// Location of `path` of /dev/input or /sys/class/input; other paths are returned unchanged.
std::string evdev_path(const char* path);

/// Like ioctl(2), for a file of an input device; false when it is not one.
bool evdev_ioctl(int file, unsigned long request, void* argument, int& result);

/// Whether the driver fails to take all of an event that is written; then `result` is that of
/// write(2).
bool evdev_write_fails(int file, const void* bytes, size_t length, long& result);

/// Like write(2), for a file of an input device; false when it is not one.
bool evdev_write(int file, const void* bytes, size_t length, long& result);

}  // namespace spidar::test
