// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/devices/device_registry.h"

#include <algorithm>
#include <memory>

#include "spidar/devices/rooms.h"
#include "spidar/link/emulated_transport.h"

namespace spidar {

// Declares the function of each device folder that returns its kinds. Meson generates rooms.h:
// ROOM(uart) ROOM(sound) …
#define ROOM(name) std::vector<DeviceKind> name##_kinds();
SPIDAR_ROOMS
#undef ROOM

namespace {

std::vector<DeviceKind> all_kinds() {
  std::vector<DeviceKind> kinds;
#define ROOM(name) \
  for (DeviceKind & kind : name##_kinds()) kinds.push_back(kind);
  SPIDAR_ROOMS
#undef ROOM
  std::stable_partition(kinds.begin(), kinds.end(),
                        [](const DeviceKind& kind) { return kind.has_strings(); });
  return kinds;
}

}  // namespace

const std::vector<DeviceKind>& devices() {
  // The list is never destroyed: when a player exits, a thread may still be reopening its board.
  static const auto& kinds = *new std::vector<DeviceKind>(all_kinds());
  return kinds;
}

DeviceName::DeviceName(const std::string& text)
    : device(text.substr(0, text.find(':'))),
      rest(device.size() == text.size() ? "" : text.substr(device.size() + 1)),
      has_end(device.size() == text.size() || !rest.empty()) {}

std::vector<const DeviceKind*> kinds_called(const std::string& device) {
  std::vector<const DeviceKind*> kinds;
  for (const DeviceKind& kind : devices()) {
    if (device == kind.device) kinds.push_back(&kind);
  }
  return kinds;
}

const DeviceKind* simulated_kind(const DeviceName& name) {
  for (const DeviceKind& kind : devices()) {
    if (name.device == "sim" && name.rest == kind.board && kind.emulate) return &kind;
  }
  return nullptr;
}

boards::AnyBoard simulated_board(const DeviceKind& kind, const std::string& name,
                                 const Profile& profile,
                                 const emulated::SimulatedMechanics& mechanics) {
  if (!kind.emulate) {
    throw DeviceError(name + ": the driver of " + kind.title + " has no emulated board",
                      DeviceErrorCode::kSettings);
  }
  std::shared_ptr<emulated::Motors> motors;
  if (kind.has_strings()) {
    motors =
        std::make_shared<emulated::SimulatedMotors>(profile, kind.traits.dac(profile), mechanics);
  } else {
    motors = kind.hand ? kind.hand() : std::make_shared<emulated::Motors>();
  }
  auto emulated = kind.emulate(std::move(motors));
  return kind.attach(name, profile, std::make_unique<emulated::Transport>(std::move(emulated)));
}

}  // namespace spidar
