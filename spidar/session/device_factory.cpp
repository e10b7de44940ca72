// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/session/device_factory.h"

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <vector>

#include "spidar/boards/board_device.h"
#include "spidar/boards/force_grip.h"
#include "spidar/boards/uart_board.h"
#include "spidar/boards/usb_board.h"
#include "spidar/emulation/wire_simulation.h"
#include "spidar/grip/string_grip.h"
#include "spidar/protocols/uart_motor.h"
#include "spidar/session/force_devices.h"
#include "spidar/simulation/simulated_device.h"
#include "spidar/transports/tty_transport.h"

namespace spidar {
namespace {

/// The names of all devices that take a force: `prefix` and each one's.
std::string known_names(const std::string& prefix, const char* ForceDevice::*name) {
  std::string names;
  for (const ForceDevice& device : force_devices()) names += ", " + prefix + device.*name;
  return names;
}

std::unique_ptr<Device> make_simulated_board(const std::string& board, const Profile& profile) {
  if (auto device = make_wire_simulation(board, profile)) return device;
  throw DeviceError("unknown simulated board \"" + board +
                    "\"; known are: sim:sh4, sim:simple, sim:uart" +
                    known_names("sim:", &ForceDevice::kind));
}

std::unique_ptr<Device> make_simulation(const std::string& spec, const std::string& board,
                                        const Profile& profile) {
  try {
    if (!board.empty()) return make_simulated_board(board, profile);
    return std::make_unique<SimulatedDevice>(profile, SimulatedDevice::Time::kClock,
                                             grip_model_of(profile));
  } catch (const std::invalid_argument& error) {
    throw DeviceError(spec + ": cannot simulate profile \"" + profile.name + "\": " + error.what());
  }
}

/// `paths` are separated by commas.
std::unique_ptr<Board> make_uart(const std::string& spec, const std::string& paths,
                                 const Profile& profile) {
  std::vector<std::unique_ptr<Transport>> lines;
  for (size_t begin = 0; begin <= paths.size();) {
    const size_t end = std::min(paths.find(',', begin), paths.size());
    if (end == begin) throw DeviceError(spec + ": a path is empty; write uart:/dev/ttyUSB0");
    const std::string path = paths.substr(begin, end - begin);
    lines.push_back(std::make_unique<TtyTransport>("uart:" + path, path, uart_motor::kBaud));
    begin = end + 1;
  }
  return std::make_unique<UartBoard>(spec, profile, std::move(lines));
}

BoardSettings resolved(BoardSettings settings, const Profile& profile) {
  if (settings.count_zero != CountZero::kByProfile) return settings;
  const bool calibrated =
      std::any_of(profile.drives.begin(), profile.drives.end(),
                  [](const StringDrive& drive) { return drive.home_offset_m != 0; });
  settings.count_zero = calibrated ? CountZero::kNever : CountZero::kFirstOpen;
  return settings;
}

}  // namespace

bool is_simulated(const std::string& spec) {
  return spec == "sim" || spec.compare(0, 4, "sim:") == 0;
}

namespace {

/// A device's name, split at its first colon.
struct Spec {
  explicit Spec(const std::string& text)
      : kind(text.substr(0, text.find(':'))),
        rest(kind.size() == text.size() ? "" : text.substr(kind.size() + 1)),
        named(kind.size() == text.size() || !rest.empty()) {}
  const std::string kind;
  const std::string rest;
  const bool named;  ///< there is something after the colon, if there is one
};

/// Null for a device with strings, and for an unknown one.
std::unique_ptr<ForceBoard> make_force_board(const std::string& text, const Profile& profile) {
  const Spec spec(text);
  const ForceDevice* device = spec.named ? force_device(spec.kind) : nullptr;
  return device ? device->make(text, spec.rest, profile) : nullptr;
}

/// Null for a simulation with strings, and for an unknown one.
std::unique_ptr<ForceBoard> simulate_force_board(const std::string& text, const Profile& profile) {
  const ForceDevice* device = is_simulated(text) ? force_device(Spec(text).rest) : nullptr;
  return device ? device->simulate(text, profile) : nullptr;
}

}  // namespace

std::unique_ptr<Device> make_device(const std::string& text, const Profile& profile,
                                    const BoardSettings& settings) {
  const Spec spec(text);
  if (make_force_board(text, profile) || simulate_force_board(text, profile))
    throw DeviceError(text + ": takes a force; it has no strings, and no encoders");
  std::unique_ptr<Board> board;
  if (spec.kind == "sim" && spec.named) return make_simulation(text, spec.rest, profile);
  if (spec.kind == "usb" && spec.named)
    board = std::make_unique<UsbBoard>(text, spec.rest, profile);
  if (spec.kind == "uart" && !spec.rest.empty()) board = make_uart(text, spec.rest, profile);
  if (!board)
    throw DeviceError("unknown device \"" + text +
                      "\"; known are: sim, sim:BOARD, none, usb, usb:ID, uart:PATH" +
                      known_names("", &ForceDevice::names));
  return std::make_unique<BoardDevice>(std::move(board), resolved(settings, profile));
}

std::unique_ptr<Grip> make_grip(const std::string& text, const Profile& profile,
                                const BoardSettings& settings) {
  if (auto board = simulate_force_board(text, profile))
    return std::make_unique<ForceGrip>(std::move(board), settings_of_simulation());
  if (auto board = make_force_board(text, profile))
    return std::make_unique<ForceGrip>(std::move(board), settings);
  return std::make_unique<StringGrip>(profile, make_device(text, profile, settings));
}

}  // namespace spidar
