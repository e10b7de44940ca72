// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/session/device_registry.h"

#include <algorithm>
#include <stdexcept>
#include <unistd.h>
#include <utility>

#include "spidar/boards/cyverse_board.h"
#include "spidar/boards/falcon_board.h"
#include "spidar/boards/force_feedback_board.h"
#include "spidar/boards/inverse3_board.h"
#include "spidar/boards/mouse_board.h"
#include "spidar/boards/sound_board.h"
#include "spidar/boards/uart_board.h"
#include "spidar/emulation/emulated_boards.h"
#include "spidar/emulation/emulated_force_devices.h"
#include "spidar/session/sound_devices.h"
#include "spidar/transports/evdev_list.h"
#include "spidar/transports/evdev_transport.h"
#include "spidar/transports/tty_transport.h"
#include "spidar/transports/websocket_transport.h"

namespace spidar {
namespace {

template <typename BoardType>
AnyBoard attach(const std::string& name, const Profile& profile,
                std::unique_ptr<Transport> transport) {
  if constexpr (std::is_base_of_v<Board, BoardType>)
    return std::unique_ptr<Board>(std::make_unique<BoardType>(name, profile, std::move(transport)));
  else
    return std::unique_ptr<ForceBoard>(std::make_unique<BoardType>(name, std::move(transport)));
}

template <typename Emulated>
std::unique_ptr<EmulatedBoard> emulate(std::shared_ptr<EmulatedMotors> motors) {
  return std::make_unique<Emulated>(std::move(motors));
}

/// What the board puts out has no effect.
std::shared_ptr<EmulatedMotors> no_motors(const Profile&, const SimulatedMechanics&) {
  return std::make_shared<EmulatedMotors>();
}

template <uint16_t inputs>
std::shared_ptr<EmulatedMotors> hand(const Profile&, const SimulatedMechanics&) {
  return std::make_shared<SpringHand>(inputs);
}

template <DacScale (*dac)(const Profile&)>
std::shared_ptr<EmulatedMotors> strings(const Profile& profile,
                                        const SimulatedMechanics& mechanics) {
  return std::make_shared<SimulatedMotors>(profile, dac(profile), mechanics);
}

AnyBoard uart_board(const std::string& name, const Profile& profile,
                    std::vector<std::unique_ptr<Transport>> lines) {
  return std::unique_ptr<Board>(std::make_unique<UartBoard>(name, profile, std::move(lines)));
}

AnyBoard attach_uart(const std::string& name, const Profile& profile,
                     std::unique_ptr<Transport> line) {
  std::vector<std::unique_ptr<Transport>> lines;
  lines.push_back(std::move(line));
  return uart_board(name, profile, std::move(lines));
}

/// `paths` are separated by commas.
AnyBoard make_uart(const std::string& name, const std::string& paths, const Profile& profile) {
  std::vector<std::unique_ptr<Transport>> lines;
  for (size_t begin = 0; begin <= paths.size();) {
    const size_t end = std::min(paths.find(',', begin), paths.size());
    if (end == begin)
      throw DeviceError(name + ": a path is empty; write uart:/dev/ttyUSB0",
                        DeviceTrouble::kSettings);
    const std::string path = paths.substr(begin, end - begin);
    lines.push_back(std::make_unique<TtyTransport>("uart:" + path, path, uart_motor::kBaud));
    begin = end + 1;
  }
  return uart_board(name, profile, std::move(lines));
}

/// Two boards of four motors, like the published pair of a SPIDAR-G.
std::unique_ptr<EmulatedBoard> emulate_uart(std::shared_ptr<EmulatedMotors> motors) {
  constexpr uart_motor::BoardInfo kB3M{5, 1, 4, 4, 0, 0};
  return std::make_unique<EmulatedUart>(std::move(motors),
                                        std::vector<EmulatedUart::Station>{{0, kB3M}, {1, kB3M}});
}

std::vector<BoardInfo> list_uart() {
  std::vector<BoardInfo> boards;
  for (const TtyLine& line : list_tty_lines()) {
    if (!line.named) continue;
    BoardInfo& board = boards.emplace_back();
    board.device = "uart:" + line.path;
    board.path = line.path;
    board.accessible = access(line.path.c_str(), R_OK | W_OK) == 0;
    if (!board.accessible) board.note = "no permission: join the group dialout";
  }
  return boards;
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
AnyBoard make_force_feedback(const std::string& name, const std::string& rest,
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
      throw DeviceError(name + ": the path is empty; write ff:/dev/input/eventN," + option,
                        DeviceTrouble::kSettings);
    if (!take_option(option, axes, options))
      throw DeviceError(
          name + ": \"" + option + "\" is unknown, out of range or given twice; write ff:" + path +
              ",axes=1 for a wheel, ff:" + path + ",axes=2 for a joystick, ff:" + path +
              ",gain=50 for 50 % of the device's strength (1 to 100), or ff:" + path +
              ",flip=x if it pushes to the wrong side",
          DeviceTrouble::kSettings);
  }
  return std::unique_ptr<ForceBoard>(std::make_unique<ForceFeedbackBoard>(
      name, profile, std::make_unique<EvdevTransport>(name, path, axes),
      ForceFeedbackBoard::Updates::kOwnThread, options));
}

AnyBoard attach_force_feedback(const std::string& name, const Profile& profile,
                               std::unique_ptr<Transport> transport) {
  return std::unique_ptr<ForceBoard>(std::make_unique<ForceFeedbackBoard>(
      name, profile, std::move(transport), ForceFeedbackBoard::Updates::kInCycle));
}

std::vector<BoardInfo> list_force_feedback_boards() {
  std::vector<BoardInfo> boards;
  for (const EvdevInfo& device : list_force_feedback()) {
    BoardInfo& board = boards.emplace_back();
    board.device = "ff:" + device.path;
    board.name = device.name;
    board.path = device.path;
    board.serial = device.serial;
    board.usb_id = device.id;
    board.directional = device.constant;
    if (!device.constant) board.note = "rumble only: strength without direction";
    if (!device.accessible) board.note = kNoUdevRule;
    board.accessible = device.accessible;
  }
  return boards;
}

/// `rest` is empty, ID, or ID,port=N.
AnyBoard make_inverse3(const std::string& name, const std::string& rest, const Profile&) {
  constexpr int kLastPort = 65535;
  const size_t comma = rest.find(',');
  int port = inverse3::kPort;
  if (comma != std::string::npos) port = option_value(rest.substr(comma + 1), "port=", kLastPort);
  if (port == 0 || comma == 0)
    throw DeviceError(name +
                          ": write inverse3, inverse3:ID or inverse3:ID,port=N, where N is the " +
                          "port of Haply's service, " + std::to_string(inverse3::kPort) +
                          " unless it was changed",
                      DeviceTrouble::kSettings);
  return std::unique_ptr<ForceBoard>(std::make_unique<Inverse3Board>(
      name, rest.substr(0, comma),
      std::make_unique<WebSocketTransport>(
          name, static_cast<uint16_t>(port),
          "start Haply's Inverse Service (Haply Hub, or: systemctl start haply-inverse-service)")));
}

AnyBoard attach_inverse3(const std::string& name, const Profile&,
                         std::unique_ptr<Transport> transport) {
  return std::unique_ptr<ForceBoard>(
      std::make_unique<Inverse3Board>(name, "", std::move(transport)));
}

/// To ask the service would be a session there.
std::vector<BoardInfo> list_inverse3() {
  if (!is_listening(inverse3::kPort)) return {};
  BoardInfo board;
  board.device = "inverse3";
  board.path = "localhost:" + std::to_string(inverse3::kPort);
  board.note = "if it is plugged in, which only Haply's service knows";
  return {board};
}

/// Of simulations: the CyVerse boards output positive volts only, which the default profile is not
/// made for. Real boards have no default (see profile_choice.h).
constexpr const char* kPositiveProfile = "spidar-g6x3-v2-r";
constexpr const char* kCyverseNote = "endpoints and D/A range are inferred";

}  // namespace

const std::vector<DeviceKind>& devices() {
  // Never destroyed: when a player exits, another thread may still be reopening its board.
  static const auto& kinds = *new std::vector<DeviceKind>{
      {{"usb",
        "CyVerse USB 2.0 SH4",
        "usb-sh4",
        {sh4::kVendor, sh4::kProduct, {sh4::kEndpointOut, sh4::kEndpointIn}},
        attach<Sh4Board>},
       "sh4",
       "usb, usb:ID",
       kPositiveProfile,
       Verification::kEmulated,
       kCyverseNote,
       emulate<EmulatedSh4>,
       strings<unipolar_dac>},
      {{"usb",
        "CyVerse USB 2.0 Simple",
        "usb-simple",
        {usb_simple::kVendor,
         usb_simple::kProduct,
         {usb_simple::kEndpointOut, usb_simple::kEndpointIn}},
        attach<SimpleBoard>},
       "simple",
       "usb, usb:ID",
       kPositiveProfile,
       Verification::kEmulated,
       kCyverseNote,
       emulate<EmulatedSimple>,
       strings<unipolar_dac>},
      {{"uart", "UART motor boards", "uart", {}, attach_uart},
       "uart",
       "uart:PATH",
       "spidar-g6x4",
       Verification::kEmulated,
       "",
       emulate_uart,
       strings<uart_dac>,
       make_uart,
       list_uart},
      {{"mouse",
        "SPIDAR-mouse",
        "",
        {mouse::kVendor, mouse::kProduct, {mouse::kEndpointOut, mouse::kEndpointIn, true}, true},
        attach<MouseBoard>},
       "mouse",
       "mouse, mouse:ID",
       kDefaultProfile,
       Verification::kInferred,
       "other devices have this id; asked when it is opened",
       emulate<EmulatedMouse>,
       no_motors},
      {{"ff", "force-feedback device", "", {}, attach_force_feedback},
       "ff",
       "ff, ff:PATH, ff:PATH,axes=N, ff:PATH,gain=PERCENT",
       kDefaultProfile,
       Verification::kEmulated,
       "",
       emulate<EmulatedForceFeedback>,
       no_motors,
       make_force_feedback,
       list_force_feedback_boards},
      {{"inverse3", "Haply Inverse3", "", {}, attach_inverse3},
       "inverse3",
       "inverse3, inverse3:ID",
       kDefaultProfile,
       Verification::kInferred,
       "",
       emulate<EmulatedInverse3>,
       hand<0>,
       make_inverse3,
       list_inverse3},
      {{"falcon",
        "Novint Falcon",
        "",
        {falcon::kVendor, falcon::kProduct, {falcon::kEndpointOut, falcon::kEndpointIn}},
        attach<FalconBoard>},
       "falcon",
       "falcon, falcon:ID",
       kDefaultProfile,
       Verification::kEmulated,
       "reach and scale of the force are inferred",
       emulate<EmulatedFalcon>,
       hand<EmulatedFalcon::kHomed>},
      {{"sound", "sound card", "", {}, attach<SoundBoard>},
       "sound",
       "sound:CARD, sound:CARD,CHANNEL=DIRECTION",
       kDefaultProfile,
       Verification::kEmulated,
       "",
       emulate<EmulatedSound>,
       no_motors,
       make_sound,
       list_sound},
  };
  return kinds;
}

DeviceName::DeviceName(const std::string& text)
    : device(text.substr(0, text.find(':'))),
      rest(device.size() == text.size() ? "" : text.substr(device.size() + 1)),
      has_end(device.size() == text.size() || !rest.empty()) {}

std::vector<const DeviceKind*> kinds_called(const std::string& device) {
  std::vector<const DeviceKind*> kinds;
  for (const DeviceKind& kind : devices())
    if (device == kind.device) kinds.push_back(&kind);
  return kinds;
}

const DeviceKind* simulated_kind(const DeviceName& name) {
  for (const DeviceKind& kind : devices())
    if (name.device == "sim" && name.rest == kind.board) return &kind;
  return nullptr;
}

AnyBoard simulated_board(const DeviceKind& kind, const std::string& name, const Profile& profile,
                         const SimulatedMechanics& mechanics) {
  auto emulated = kind.emulate(kind.simulated_motors(profile, mechanics));
  return kind.attach(
      name, profile,
      std::make_unique<EmulatedTransport>(std::move(emulated), std::make_shared<EmulatedWire>()));
}

}  // namespace spidar
