// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/session/force_devices.h"

#include <algorithm>

#include "spidar/boards/falcon_board.h"
#include "spidar/boards/force_feedback_board.h"
#include "spidar/boards/inverse3_board.h"
#include "spidar/boards/mouse_board.h"
#include "spidar/boards/usb_force_board.h"
#include "spidar/emulation/emulated_force_feedback.h"
#include "spidar/emulation/emulated_inverse3.h"
#include "spidar/emulation/emulated_transport.h"
#include "spidar/emulation/emulated_usb.h"
#include "spidar/emulation/held_falcon.h"
#include "spidar/emulation/spring_hand.h"
#include "spidar/transports/evdev_transport.h"
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

}  // namespace spidar
