// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <iomanip>
#include <iostream>

#include "spidar/profiles/profile.h"
#include "spidar/session/board_list.h"
#include "spidar/tools/command_line.h"
#include "spidar/tools/commands.h"
#include "spidar/tools/json_text.h"
#include "spidar/transports/tty_list.h"

namespace spidar {
namespace {

constexpr const char* kListHelp = R"(usage: spidarctl list [--json]

Lists the devices, how far the driver of each has been tested, the serial lines to which motor
boards may be connected, and the profiles. No device is opened.
)";

struct NamedProfile {
  std::string name;
  std::string description;
  std::string trouble;  // why it cannot be used
};

std::vector<NamedProfile> profiles() {
  std::vector<NamedProfile> found;
  for (const std::string& name : list_profiles()) {
    try {
      found.push_back({name, load_profile(name).description, ""});
    } catch (const ProfileError& error) {
      found.push_back({name, "", error.what()});
    }
  }
  return found;
}

void print() {
  std::cout << "devices\n";
  for (const BoardInfo& board : list_boards()) {
    std::cout << "  " << std::left << std::setw(12) << board.device << "  " << board.name << "; "
              << to_string(board.trial);
    if (!board.serial.empty()) std::cout << "; serial number " << board.serial;
    if (!board.note.empty()) std::cout << "; " << board.note;
    std::cout << '\n';
  }
  std::cout << "\nserial lines (motor boards may be connected to them)\n";
  int lines = 0;
  for (const TtyLine& line : list_tty_lines()) {
    if (line.named) continue;
    std::cout << "  uart:" << line.path << '\n';
    ++lines;
  }
  if (lines == 0) std::cout << "  none\n";
  std::cout << "\nprofiles\n";
  for (const NamedProfile& profile : profiles())
    std::cout << "  " << profile.name << "  "
              << (profile.trouble.empty() ? profile.description
                                          : "cannot be used: " + profile.trouble)
              << '\n';
}

void print_json() {
  toml::array devices, lines, usable;
  for (const BoardInfo& board : list_boards())
    devices.push_back(toml::table{{"device", board.device},
                                  {"board", board.name},
                                  {"evidence", to_string(board.trial)},
                                  {"path", board.path},
                                  {"serial", board.serial},
                                  {"usb_id", board.usb_id},
                                  {"profile", board.profile},
                                  {"accessible", board.accessible},
                                  {"note", board.note}});
  for (const TtyLine& line : list_tty_lines())
    if (!line.named) lines.push_back("uart:" + line.path);
  for (const NamedProfile& profile : profiles())
    if (profile.trouble.empty())
      usable.push_back(toml::table{{"name", profile.name}, {"description", profile.description}});
  std::cout << json_text(
      toml::table{{"devices", devices}, {"serial_lines", lines}, {"profiles", usable}});
}

}  // namespace

int list_command(int argc, char** argv) {
  bool json = false, help = false;
  const std::vector<std::string> rest = parse_options(
      argc, argv, {json_option(json), {"help", false, [&](const std::string&) { help = true; }}});
  if (!rest.empty()) throw UsageError(rest.front() + ": list takes no arguments");
  if (help) {
    std::cout << kListHelp;
  } else if (json) {
    print_json();
  } else {
    print();
  }
  return kDone;
}

}  // namespace spidar
