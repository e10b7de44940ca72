// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/boards/board_list.h"

#include <unistd.h>

#include "spidar/boards/usb_kinds.h"
#include "spidar/device.h"
#include "spidar/profiles/profile.h"
#include "spidar/transports/evdev_list.h"
#include "spidar/transports/tty_list.h"
#include "spidar/transports/usb_bus.h"

namespace spidar {
namespace {

/// The CyVerse boards put out positive volts only, which the default profile is not made for.
constexpr const char* kPositiveProfile = "spidar-g6x3-v2-r";
constexpr const char* kUartProfile = "spidar-g6x4";

constexpr const char* kSimulated[][3] = {
    {"sim", "simulated SPIDAR", kDefaultProfile},
    {"sim:sh4", "simulated SPIDAR behind the SH4 board's packets", kPositiveProfile},
    {"sim:simple", "simulated SPIDAR behind the Simple board's packets", kPositiveProfile},
    {"sim:uart", "simulated SPIDAR behind the UART boards' packets", kUartProfile},
    {"sim:mouse", "simulated SPIDAR-mouse", kDefaultProfile},
    {"sim:ff", "simulated force-feedback joystick", kDefaultProfile},
};

bool begins(const std::string& text, const std::string& with) {
  return text.compare(0, with.size(), with) == 0;
}

/// It takes a force instead of tensions.
bool takes_force(const std::string& device) {
  const std::string board = begins(device, "sim:") ? device.substr(4) : device;
  const std::string kind = board.substr(0, board.find(':'));
  return kind == "mouse" || kind == "ff";
}

BoardInfo force_feedback(const EvdevInfo& device) {
  BoardInfo board;
  board.device = "ff:" + device.path;
  board.name = device.name.empty() ? "force-feedback device" : device.name;
  board.path = device.path;
  board.serial = device.serial;
  board.usb_id = device.id;
  if (!device.constant) board.note = "rumble only: strength without direction";
  if (!device.accessible) board.note = "no permission: udev rule 70-spidar.rules";
  board.accessible = device.accessible;
  board.profile = default_profile(board.device);
  board.has_strings = false;
  return board;
}

BoardInfo uart_board(const std::string& device, const std::string& path) {
  BoardInfo board;
  board.device = device;
  board.name = "UART motor boards";
  board.path = path;
  board.accessible = access(path.c_str(), R_OK | W_OK) == 0;
  if (!board.accessible) board.note = "no permission: join the group dialout";
  board.profile = default_profile(device);
  return board;
}

}  // namespace

const char* to_string(Trial trial) noexcept {
  switch (trial) {
    case Trial::kHardware:
      return "tried on hardware";
    case Trial::kEmulated:
      return "emulated";
    case Trial::kInferred:
      return "inferred";
  }
  return "unknown";
}

std::vector<BoardInfo> list_boards() {
  std::vector<BoardInfo> boards;
  for (const UsbBoardKind& kind : usb_kinds()) {
    std::vector<UsbDeviceInfo> devices;
    try {
      devices = list_usb_devices(kind.vendor, kind.product);
    } catch (const DeviceError&) {
      break;  // no USB
    }
    for (const UsbDeviceInfo& device : devices) {
      const std::string spec = std::string(device_of(kind.family)) + ":" + device.path;
      boards.push_back({spec, kind.name, device.path, device.serial, kind.id(), kind.trial,
                        device.accessible ? kind.note : "no permission: udev rule 70-spidar.rules",
                        device.accessible, default_profile(spec), !takes_force(spec)});
    }
  }
  for (const TtyLine& line : list_tty_lines())
    if (line.named) boards.push_back(uart_board("uart:" + line.path, line.path));
  for (const EvdevInfo& device : list_force_feedback()) boards.push_back(force_feedback(device));
  for (const auto& simulated : kSimulated)
    boards.push_back({simulated[0], simulated[1], "", "", "", Trial::kEmulated, "", true,
                      simulated[2], !takes_force(simulated[0])});
  return boards;
}

std::string default_profile(const std::string& device) {
  for (const auto& simulated : kSimulated)
    if (device == simulated[0]) return simulated[2];
  const std::string kind = device.substr(0, device.find(':'));
  if (kind == "usb") return kPositiveProfile;
  return kind == "uart" ? kUartProfile : kDefaultProfile;
}

BoardInfo board_info(const std::string& device) {
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
  BoardInfo unknown;
  unknown.device = device;
  unknown.profile = default_profile(device);
  if (kind == "usb") {
    unknown.name = "CyVerse USB 2.0";
  } else if (kind == "mouse") {
    unknown.name = "SPIDAR-mouse";
    unknown.trial = Trial::kInferred;
    unknown.has_strings = false;
  } else if (kind == "ff") {
    unknown.name = "force-feedback device";
    unknown.path = id;
    unknown.has_strings = false;
  } else if (kind == "uart" && !id.empty()) {
    return uart_board(device, id.substr(0, id.find(',')));
  }
  return unknown;
}

}  // namespace spidar
