// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/session/device_factory.h"

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <vector>

#include "spidar/boards/falcon_board.h"
#include "spidar/boards/force_feedback_board.h"
#include "spidar/boards/force_grip.h"
#include "spidar/boards/inverse3_board.h"
#include "spidar/boards/link_thread.h"
#include "spidar/boards/mouse_board.h"
#include "spidar/boards/uart_board.h"
#include "spidar/boards/usb_board.h"
#include "spidar/emulation/emulated_boards.h"
#include "spidar/emulation/emulated_force_devices.h"
#include "spidar/emulation/emulated_transport.h"
#include "spidar/emulation/wire_simulation.h"
#include "spidar/grip/string_grip.h"
#include "spidar/protocols/uart_motor.h"
#include "spidar/simulation/simulated_device.h"
#include "spidar/transports/evdev_transport.h"
#include "spidar/transports/tty_transport.h"
#include "spidar/transports/websocket_transport.h"

namespace spidar {
namespace {

/// A force without effect.
class NoMotors final : public EmulatedMotors {
 public:
  void put_out(const std::array<int, kMaxStrings>&) noexcept override {}
  std::array<int32_t, kMaxStrings> counts() noexcept override { return {}; }
};
NoMotors no_motors;  // has nothing that could be shared

/// `Emulated` at the other end of a wire.
template <typename Emulated, typename... Arguments>
std::unique_ptr<Transport> wire_to(Arguments&... arguments) {
  return std::make_unique<EmulatedTransport>(std::make_unique<Emulated>(arguments...),
                                             std::make_shared<EmulatedWire>());
}

template <UsbFamily family>
std::unique_ptr<ForceBoard> make_usb(const std::string& spec, const std::string& rest,
                                     const Profile&) {
  return std::make_unique<UsbForceBoard>(family, spec, rest);
}

std::unique_ptr<ForceBoard> simulate_mouse(const std::string& spec, const Profile&) {
  return std::make_unique<MouseBoard>(spec, wire_to<EmulatedMouse>(no_motors));
}

std::unique_ptr<ForceBoard> simulate_falcon(const std::string& spec, const Profile&) {
  return std::make_unique<FalconBoard>(spec, wire_to<HeldFalcon>());
}

/// A number from 1 to `largest` after `name`; 0 if it is something else.
int option_value(const std::string& option, const std::string& name, int largest) {
  if (option.compare(0, name.size(), name) != 0) return 0;
  const std::string digits = option.substr(name.size());
  if (digits.empty() || digits.size() > 5) return 0;
  if (digits.find_first_not_of("0123456789") != std::string::npos) return 0;
  const int value = std::stoi(digits);
  return value <= largest ? value : 0;
}

/// One of axes=N, gain=PERCENT, flip=x, flip=y and flip=xy. Returns false if it is none of them, or
/// was given before.
bool take_option(const std::string& option, int& axes, StickEffects::Options& options) {
  if (axes == 0 && (axes = option_value(option, "axes=", 2)) != 0) return true;
  if (options.gain == 0 && (options.gain = option_value(option, "gain=", 100) / 100.0) != 0)
    return true;
  if (options.flipped[0] || options.flipped[1]) return false;
  options.flipped = {option == "flip=x" || option == "flip=xy",
                     option == "flip=y" || option == "flip=xy"};
  return options.flipped[0] || options.flipped[1];
}

/// `rest` is empty, PATH, or PATH with options after commas.
std::unique_ptr<ForceBoard> make_force_feedback(const std::string& spec, const std::string& rest,
                                                const Profile& profile) {
  const size_t comma = rest.find(',');
  const std::string path = rest.substr(0, comma);
  int axes = 0;
  StickEffects::Options options;
  for (size_t at = comma; at != std::string::npos;) {
    const size_t end = rest.find(',', at + 1);
    const std::string option = rest.substr(at + 1, end == std::string::npos ? end : end - at - 1);
    at = end;
    if (path.empty())
      throw DeviceError(spec + ": the path is empty; write ff:/dev/input/eventN," + option);
    if (!take_option(option, axes, options))
      throw DeviceError(spec + ": \"" + option + "\" is not known; write ff:" + path +
                        ",axes=1 for a wheel, ff:" + path + ",axes=2 for a joystick, ff:" + path +
                        ",gain=50 for 50 % of the device's strength, or ff:" + path +
                        ",flip=x if it pushes to the wrong side");
  }
  return std::make_unique<ForceFeedbackBoard>(spec, profile,
                                              std::make_unique<EvdevTransport>(spec, path, axes),
                                              ForceFeedbackBoard::Updates::kOwnThread, options);
}

/// `rest` is empty, ID, or ID,port=N.
std::unique_ptr<ForceBoard> make_inverse3(const std::string& spec, const std::string& rest,
                                          const Profile&) {
  constexpr int kLastPort = 65535;
  const size_t comma = rest.find(',');
  int port = inverse3::kPort;
  if (comma != std::string::npos) port = option_value(rest.substr(comma + 1), "port=", kLastPort);
  if (port == 0 || comma == 0)
    throw DeviceError(
        spec + ": write inverse3, inverse3:ID or inverse3:ID,port=N, where N is the " +
        "port of Haply's service, " + std::to_string(inverse3::kPort) + " unless it was changed");
  return std::make_unique<Inverse3Board>(
      spec, rest.substr(0, comma),
      std::make_unique<WebSocketTransport>(
          spec, static_cast<uint16_t>(port),
          "start Haply's Inverse Service (Haply Hub, or: systemctl start haply-inverse-service)"));
}

std::unique_ptr<ForceBoard> simulate_force_feedback(const std::string& spec,
                                                    const Profile& profile) {
  return std::make_unique<ForceFeedbackBoard>(spec, profile,
                                              wire_to<EmulatedForceFeedback>(no_motors),
                                              ForceFeedbackBoard::Updates::kInCycle);
}

std::unique_ptr<ForceBoard> simulate_inverse3(const std::string& spec, const Profile&) {
  return std::make_unique<Inverse3Board>(spec, "", wire_to<Held<EmulatedInverse3>>());
}

}  // namespace

const std::vector<ForceDevice>& force_devices() {
  static const std::vector<ForceDevice> devices = {
      {"mouse", "SPIDAR-mouse", "simulated SPIDAR-mouse", "mouse, mouse:ID", Trial::kInferred,
       make_usb<UsbFamily::kMouse>, simulate_mouse},
      {"ff", "force-feedback device", "simulated force-feedback joystick",
       "ff, ff:PATH, ff:PATH,axes=N, ff:PATH,gain=PERCENT", Trial::kEmulated, make_force_feedback,
       simulate_force_feedback},
      {"inverse3", "Haply Inverse3", "simulated Haply Inverse3 in a hand", "inverse3, inverse3:ID",
       Trial::kInferred, make_inverse3, simulate_inverse3},
      {"falcon", "Novint Falcon", "simulated Novint Falcon in a hand", "falcon, falcon:ID",
       Trial::kEmulated, make_usb<UsbFamily::kFalcon>, simulate_falcon},
  };
  return devices;
}

const ForceDevice* force_device(const std::string& kind) {
  const std::vector<ForceDevice>& devices = force_devices();
  const auto found = std::find_if(devices.begin(), devices.end(),
                                  [&](const ForceDevice& device) { return kind == device.kind; });
  return found == devices.end() ? nullptr : &*found;
}

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
  if (!board) {
    // Only an element, which analyses pictures, does without a device: this is not asked about it.
    const bool is_none = text == "none";
    throw DeviceError(
        (is_none ? std::string("\"none\" is no device") : "unknown device \"" + text + "\"") +
        "; known are: sim, sim:BOARD, " + (is_none ? "" : "none, ") + "usb, usb:ID, uart:PATH" +
        known_names("", &ForceDevice::names));
  }
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
