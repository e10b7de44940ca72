// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/devices/device_registry.h"

#include <algorithm>
#include <array>
#include <memory>

#include "spidar/devices/device_folders.h"
#include "spidar/devices/sim/simulated_device.h"
#include "spidar/link/board_parts.h"
#include "spidar/link/emulated_transport.h"

namespace spidar {

// Declares the function of each device folder that returns its kinds. Meson generates
// device_folders.h: DEVICE_FOLDER(uart) DEVICE_FOLDER(sound) …
#define DEVICE_FOLDER(name) std::vector<DeviceKind> name##_kinds();
SPIDAR_DEVICE_FOLDERS
#undef DEVICE_FOLDER

namespace {

std::vector<DeviceKind> all_kinds() {
  std::vector<DeviceKind> kinds;
#define DEVICE_FOLDER(name) \
  for (DeviceKind & kind : name##_kinds()) kinds.push_back(kind);
  SPIDAR_DEVICE_FOLDERS
#undef DEVICE_FOLDER
  std::stable_partition(kinds.begin(), kinds.end(),
                        [](const DeviceKind& kind) { return kind.has_strings(); });
  return kinds;
}

/// The motors and encoders of a SimulatedDevice behind an emulated board. The mechanics advance
/// when the board outputs digits.
class SimulatedMotors final : public emulated::Motors {
 public:
  /// `dac` belongs to the board. Throws std::invalid_argument as SimulatedDevice does.
  SimulatedMotors(const Profile& profile, const boards::DacScale& dac,
                  const SimulatedMechanics& mechanics)
      : device_(profile, SimulatedDevice::Time::kClock,
                mechanics.model.value_or(grip_model_of(profile)), mechanics.clock),
        dac_(dac) {
    device_.open();
  }
  ~SimulatedMotors() override { device_.close(); }

  void set_outputs(const std::array<int, kMaxStrings>& digits) noexcept override {
    MotorVolts volts;
    for (size_t i = 0; i < digits.size(); ++i) volts.volt[i] = dac_.volt(digits[i]);
    device_.exchange(volts, reading_);
  }
  std::array<int32_t, kMaxStrings> counts() noexcept override { return reading_.count; }

 private:
  SimulatedDevice device_;
  const boards::DacScale dac_;
  DeviceReading reading_;
};

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
                                 const Profile& profile, const SimulatedMechanics& mechanics) {
  std::shared_ptr<emulated::Motors> motors;
  if (kind.has_strings()) {
    motors = std::make_shared<SimulatedMotors>(profile, kind.traits.dac(profile), mechanics);
  } else {
    motors = kind.hand ? kind.hand() : std::make_shared<emulated::Motors>();
  }
  auto emulated = kind.emulate(std::move(motors));
  return kind.attach(name, profile, std::make_unique<emulated::Transport>(std::move(emulated)));
}

}  // namespace spidar
