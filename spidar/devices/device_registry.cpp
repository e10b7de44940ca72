// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/devices/device_registry.h"

#include <memory>

#include "spidar/emulation/emulated_transport.h"

namespace spidar {

const std::vector<DeviceKind>& devices() {
  // Never destroyed: when a player exits, another thread may still be reopening its board.
  static const auto& kinds = *new std::vector<DeviceKind>{
      sh4_kind(),      simple_kind(), uart_kind(),  mouse_kind(), force_feedback_kind(),
      inverse3_kind(), falcon_kind(), sound_kind(),
  };
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
    if (name.device == "sim" && name.rest == kind.board) return &kind;
  }
  return nullptr;
}

boards::AnyBoard simulated_board(const DeviceKind& kind, const std::string& name,
                                 const Profile& profile,
                                 const emulated::SimulatedMechanics& mechanics) {
  auto emulated = kind.emulate(kind.simulated_motors(profile, mechanics));
  return kind.attach(name, profile,
                     std::make_unique<emulated::Transport>(std::move(emulated),
                                                           std::make_shared<emulated::Wire>()));
}

}  // namespace spidar
