// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/session/board_list.h"

#include <filesystem>
#include <system_error>
#include <unistd.h>

#include "spidar/device.h"
#include "spidar/devices/device_registry.h"
#include "spidar/devices/usb_search.h"
#include "spidar/profiles/profile.h"
#include "spidar/session/device_factory.h"
#include "spidar/session/profile_choice.h"
#include "spidar/transports/usb_transport.h"

namespace spidar {
namespace {

void describe(DeviceInfo& board, const DeviceKind& kind) {
  if (board.name.empty()) board.name = kind.title;
  if (board.note.empty()) board.note = kind.note;
  board.profile_board = kind.profile_board;
  board.evidence = kind.evidence;
  board.has_strings = kind.has_strings();
  if (!board.has_strings) board.profile = kind.profile;
}

DeviceInfo simulation(const std::string& device, const DeviceKind* kind) {
  DeviceInfo board;
  board.device = device;
  board.name = std::string("simulated ") + (kind ? kind->title : "SPIDAR");
  board.profile = kind ? kind->profile : kDefaultProfile;
  board.has_strings = !kind || kind->has_strings();
  return board;
}

DeviceInfo of_name(const std::string& device) {
  const DeviceName name(device);
  const DeviceKind* const simulated = simulated_kind(name);
  if (simulated || device == "sim") return simulation(device, simulated);
  DeviceInfo board;
  board.device = device;
  std::string titles;
  const auto kinds = kinds_called(name.device);
  for (const DeviceKind* kind : kinds) {
    titles += (titles.empty() ? "" : " or ") + std::string(kind->title);
    describe(board, *kind);
    board.note.clear();
    if (kinds.size() > 1) board.profile_board.clear();
  }
  board.name = titles;
  return board;
}

std::vector<DeviceInfo> list_usb(const DeviceKind& kind) {
  std::vector<DeviceInfo> boards;
  std::vector<UsbDeviceInfo> devices;
  try {
    devices = list_usb_devices(kind.usb.vendor, kind.usb.product);
  } catch (const DeviceError&) {  // no USB
  }
  for (const UsbDeviceInfo& device : devices) {
    DeviceInfo& board = boards.emplace_back();
    board.device = std::string(kind.device) + ":" + device.path;
    board.path = device.path;
    board.serial = device.serial;
    board.usb_id = kind.usb.text();
    board.accessible = device.accessible;
    if (!device.accessible) board.note = kNoUdevRule;
    if (!kind.has_strings()) continue;
    try {
      board.profile = remembered_profile(board.usb_id, board.serial);
    } catch (const ProfileError& error) {
      board.memory_error = error.what();
    }
  }
  return boards;
}

void add_plugged_in(const DeviceKind& kind, std::vector<DeviceInfo>& boards) {
  for (DeviceInfo& board : kind.list ? kind.list() : list_usb(kind)) {
    describe(board, kind);
    if (!board.memory_error.empty()) {
      board.note += (board.note.empty() ? "" : "; ") + board.memory_error;
    }
    boards.push_back(std::move(board));
  }
}

}  // namespace

std::vector<DeviceInfo> list_boards() {
  std::vector<DeviceInfo> boards;
  for (const DeviceKind& kind : devices()) add_plugged_in(kind, boards);
  boards.push_back(simulation("sim", nullptr));
  for (const DeviceKind& kind : devices()) {
    if (kind.emulate) boards.push_back(simulation(std::string("sim:") + kind.board, &kind));
  }
  return boards;
}

std::string default_profile(const std::string& device) {
  const DeviceInfo board = of_name(device);
  return board.name.empty() ? kDefaultProfile : board.profile;
}

DeviceInfo board_info(const std::string& device) {
  const DeviceName name(device);
  const auto kinds = kinds_called(name.device);
  const std::string id = name.rest.substr(0, name.rest.find(','));  // options follow the comma
  // Only kinds with this name are listed.
  std::vector<DeviceInfo> boards;
  for (const DeviceKind* kind : kinds) add_plugged_in(*kind, boards);
  const DeviceInfo* only = nullptr;
  int of_kind = 0;
  for (const DeviceInfo& board : boards) {
    if (board.device == device) return board;
    if (!id.empty() && (board.serial == id || board.path == id)) {
      DeviceInfo found = board;
      if (id != name.rest) found.device = device;
      return found;
    }
    only = &board;
    ++of_kind;
  }
  if (id.empty() && of_kind == 1) return *only;
  if (of_kind == 1 && only->has_strings && !only->usb_id.empty() && rotary_of(id) >= 0) {
    // Only opening the board reads the rotary switch.
    DeviceInfo board = *only;
    board.device = device;
    return board;
  }
  DeviceInfo absent = of_name(device);
  if (!kinds.empty() && kinds[0]->needs_rest() && id.empty()) absent.name.clear();
  if (id[0] == '/') {
    absent.path = id;
    absent.accessible = access(id.c_str(), R_OK | W_OK) == 0;
  }
  return absent;
}

namespace {

/// Returns DeviceKind::chosen_as; for a simulation, an empty text.
std::string chosen_as(const DeviceInfo& board) {
  const auto kinds = kinds_called(DeviceName(board.device).device);
  return kinds.empty() ? "" : kinds[0]->chosen_as;
}

std::string other_profile(const DeviceInfo& board, const std::string& named) {
  return "its confirmed profile is " + board.profile + ", and not " + named +
         "; device=" + board.device + " profile=" + named + " uses this one once";
}

std::string unconfirmed(const DeviceInfo& board) {
  const std::string named = "device=" + board.device + " profile=NAME";
  const std::string once = "spidarctl choose " + board.device + " --profile NAME";
  return "this " + board.name + " has no confirmed profile, without which its motors get no force" +
         (board.memory_error.empty() ? "" : " (" + board.memory_error + ")") +
         (board.serial.empty() ? "; name it each time: " + named : "; confirm it: " + once) + " (" +
         fitting_text(board) + ")";
}

}  // namespace

bool is_same_profile(const std::string& one, const std::string& other) {
  std::error_code none;
  return one == other || std::filesystem::equivalent(one, other, none);
}

std::vector<AutoDevice> auto_devices(const std::string& profile) {
  std::vector<AutoDevice> found;
  const std::vector<DeviceInfo> boards = list_boards();
  std::vector<const DeviceInfo*> spidars;
  for (const DeviceInfo& board : boards) {
    if (board.has_strings && !is_simulated(board.device)) spidars.push_back(&board);
  }
  for (const DeviceInfo* board : spidars) {
    if (!board->profile.empty() && (profile.empty() || is_same_profile(board->profile, profile))) {
      found.push_back({board->device, "a SPIDAR whose profile was confirmed", ""});
    }
  }
  const bool is_meant =
      !profile.empty() && found.empty() && spidars.size() == 1 && spidars[0]->profile.empty();
  for (const DeviceInfo* board : spidars) {
    if (is_meant) {
      found.push_back(
          {board->device, "the SPIDAR that is plugged in, with profile=" + profile, ""});
    } else if (board->profile.empty()) {
      found.push_back({board->device, "", unconfirmed(*board)});
    } else if (!profile.empty() && !is_same_profile(board->profile, profile)) {
      found.push_back({board->device, "", other_profile(*board, profile)});
    }
  }
  for (const bool directional : {true, false}) {
    for (const DeviceInfo& board : boards) {
      const std::string why = chosen_as(board);
      if (why.empty() || board.directional != directional) continue;
      found.push_back({board.device, directional ? why : "a gamepad that rumbles", ""});
    }
  }
  for (const DeviceInfo& board : boards) {
    if (board.has_strings || board.usb_id.empty() || !chosen_as(board).empty()) continue;
    const std::string device = DeviceName(board.device).device;
    found.push_back({board.device, "", "a " + board.name + " is used only with device=" + device});
  }
  return found;
}

}  // namespace spidar
