// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/session/board_list.h"

#include <fstream>
#include <limits>
#include <optional>
#include <sstream>
#include <string>
#include <unistd.h>

#include "spidar/boards/usb_board.h"
#include "spidar/device.h"
#include "spidar/profiles/profile.h"
#include "spidar/protocols/inverse3.h"
#include "spidar/session/device_factory.h"
#include "spidar/session/profile_choice.h"
#include "spidar/transports/evdev_list.h"
#include "spidar/transports/tty_transport.h"
#include "spidar/transports/usb_bus.h"

namespace spidar {
namespace {

/// Reads the table that proc_pid_net(5) describes: number, local address, remote address, state.
bool has_listener(const char* path, uint16_t port) {
  const std::string kListen = "0A";
  std::ifstream list(path);
  list.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
  for (std::string line; std::getline(list, line);) {
    std::istringstream words(line);
    std::string number, local, remote, state;
    words >> number >> local >> remote >> state;
    const size_t colon = local.find(':');
    if (state != kListen || colon == std::string::npos) continue;
    if (std::stoul(local.substr(colon + 1), nullptr, 16) == port) return true;
  }
  return false;
}

}  // namespace

bool is_listening(uint16_t port) {
  return has_listener("/proc/net/tcp", port) || has_listener("/proc/net/tcp6", port);
}

namespace {

/// Of simulations: the CyVerse boards output positive volts only, which the default profile is not
/// made for. Real boards have no default (see profile_choice.h).
constexpr const char* kPositiveProfile = "spidar-g6x3-v2-r";
constexpr const char* kUartProfile = "spidar-g6x4";
constexpr const char* kUartBoard = "uart";

/// Properties of a kind of device, selected by the part of its name before the colon. Those of
/// devices without strings are in force_devices().
struct DeviceKind {
  const char* kind;
  const char* name;
  const char* profile;
  Trial trial;
  bool has_strings = true;  ///< otherwise it takes a force instead of tensions
};

constexpr DeviceKind kKinds[] = {
    {"usb", "CyVerse USB 2.0", "", Trial::kEmulated},
    {"uart", "UART motor boards", "", Trial::kEmulated},
};

/// Simulated devices with strings, whose names have no variable part.
constexpr DeviceKind kSimulated[] = {
    {"sim", "simulated SPIDAR", kDefaultProfile, Trial::kEmulated},
    {"sim:sh4", "simulated SPIDAR behind the SH4 board's packets", kPositiveProfile,
     Trial::kEmulated},
    {"sim:simple", "simulated SPIDAR behind the Simple board's packets", kPositiveProfile,
     Trial::kEmulated},
    {"sim:uart", "simulated SPIDAR behind the UART boards' packets", kUartProfile,
     Trial::kEmulated},
};

bool begins(const std::string& text, const std::string& with) {
  return text.compare(0, with.size(), with) == 0;
}

/// Nothing when no device has this name.
std::optional<DeviceKind> kind_of(const std::string& device) {
  for (const DeviceKind& simulated : kSimulated)
    if (device == simulated.kind) return simulated;
  const size_t colon = device.find(':');
  const std::string kind = device.substr(0, colon);
  for (const DeviceKind& known : kKinds)
    if (kind == known.kind) return known;
  const bool is_sim = kind == "sim" && colon != std::string::npos;
  const ForceDevice* force = force_device(is_sim ? device.substr(colon + 1) : kind);
  if (!force) return std::nullopt;
  return DeviceKind{force->kind, is_sim ? force->simulated : force->title, kDefaultProfile,
                    is_sim ? Trial::kEmulated : force->trial, false};
}

/// Everything that the name alone determines.
BoardInfo of_name(const std::string& device) {
  BoardInfo board;
  board.device = device;
  board.profile = default_profile(device);
  if (const auto kind = kind_of(device)) {
    board.name = kind->name;
    board.trial = kind->trial;
    board.has_strings = kind->has_strings;
    if (kind->kind == std::string("uart")) board.profile_board = kUartBoard;
  }
  return board;
}

BoardInfo force_feedback(const EvdevInfo& device) {
  BoardInfo board = of_name("ff:" + device.path);
  if (!device.name.empty()) board.name = device.name;
  board.path = device.path;
  board.serial = device.serial;
  board.usb_id = device.id;
  if (!device.constant) board.note = "rumble only: strength without direction";
  if (!device.accessible) board.note = "no permission: udev rule 70-spidar.rules";
  board.accessible = device.accessible;
  return board;
}

/// To ask the service would be a session there.
BoardInfo inverse3_service() {
  BoardInfo board = of_name("inverse3");
  board.path = "localhost:" + std::to_string(inverse3::kPort);
  board.note = "if it is plugged in, which only Haply's service knows";
  return board;
}

BoardInfo uart_board(const std::string& device, const std::string& path) {
  BoardInfo board = of_name(device);
  board.path = path;
  board.accessible = access(path.c_str(), R_OK | W_OK) == 0;
  if (!board.accessible) board.note = "no permission: join the group dialout";
  return board;
}

BoardInfo usb_board(const UsbBoardKind& kind, const UsbDeviceInfo& device) {
  BoardInfo board = of_name(std::string(device_of(kind.family)) + ":" + device.path);
  board.name = kind.name;
  board.path = device.path;
  board.serial = device.serial;
  board.usb_id = kind.id();
  board.profile_board = kind.profile_board;
  board.trial = kind.trial;
  board.note = device.accessible ? kind.note : "no permission: udev rule 70-spidar.rules";
  board.accessible = device.accessible;
  if (!board.has_strings) return board;
  try {
    board.profile = remembered_profile(board.usb_id, board.serial);
  } catch (const ProfileError& error) {
    board.memory_trouble = error.what();
    board.note += (board.note.empty() ? "" : "; ") + board.memory_trouble;
  }
  return board;
}

}  // namespace

std::vector<BoardInfo> list_boards() {
  std::vector<BoardInfo> boards;
  for (const UsbBoardKind& kind : usb_kinds()) {
    std::vector<UsbDeviceInfo> devices;
    try {
      devices = list_usb_devices(kind.vendor, kind.product);
    } catch (const DeviceError&) {
      break;  // no USB
    }
    for (const UsbDeviceInfo& device : devices) boards.push_back(usb_board(kind, device));
  }
  for (const TtyLine& line : list_tty_lines())
    if (line.named) boards.push_back(uart_board("uart:" + line.path, line.path));
  for (const EvdevInfo& device : list_force_feedback()) boards.push_back(force_feedback(device));
  if (is_listening(inverse3::kPort)) boards.push_back(inverse3_service());
  for (const DeviceKind& simulated : kSimulated) boards.push_back(of_name(simulated.kind));
  for (const ForceDevice& device : force_devices())
    boards.push_back(of_name(std::string("sim:") + device.kind));
  return boards;
}

std::string default_profile(const std::string& device) {
  const auto kind = kind_of(device);
  return kind ? kind->profile : kDefaultProfile;
}

BoardInfo board_info(const std::string& device) {
  if (const size_t comma = device.find(','); begins(device, "ff:") && comma != std::string::npos) {
    BoardInfo board = board_info(device.substr(0, comma));
    board.device = device;
    return board;
  }
  const std::vector<BoardInfo> boards = list_boards();
  const size_t colon = device.find(':');
  const std::string kind = device.substr(0, colon);
  const std::string id = colon == std::string::npos ? "" : device.substr(colon + 1);
  const BoardInfo* only = nullptr;
  int of_kind = 0;
  for (const BoardInfo& board : boards) {
    if (board.device == device) return board;
    if (kind == "sim" || !begins(board.device, kind + ":")) continue;
    if (!id.empty() && board.serial == id) return board;
    only = &board;
    ++of_kind;
  }
  if (id.empty() && of_kind == 1) return *only;
  if (kind == "usb" && of_kind == 1 && rotary_of(id) >= 0) {
    // Whether its switch is so is seen when it is opened.
    BoardInfo board = *only;
    board.device = device;
    return board;
  }
  if (kind == "uart" && !id.empty()) return uart_board(device, id.substr(0, id.find(',')));
  BoardInfo absent = of_name(device);
  if (kind == "uart") absent.name.clear();  // make_device() requires the path of a line
  if (kind == "ff") absent.path = id;
  return absent;
}

}  // namespace spidar
