// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Looks after SPIDARs: what there is, what it does, and where its encoders are zero.

#include <exception>
#include <iostream>
#include <string>

#include "spidar/tools/command_line.h"
#include "spidar/tools/commands.h"

namespace {

using namespace spidar;

struct Command {
  const char* name;
  int (*run)(int argc, char** argv);
};

constexpr Command kCommands[] = {
    {"list", list_command},           {"info", info_command},
    {"monitor", monitor_command},     {"rest", rest_command},
    {"zero", zero_command},           {"pull", pull_command},
    {"selftest", selftest_command},   {"conformance", conformance_command},
    {"calibrate", calibrate_command},
};

constexpr const char* kHelp = R"(usage: spidarctl COMMAND

  list         devices and profiles that there are
  info         what a device is and what it reads
  monitor      where the grip is, live
  rest         hold the strings at their smallest tension
  zero         take the motors to zero
  pull         pull one string
  selftest     find motors and encoders that are swapped or reversed
  conformance  try a board and write a report to send in
  calibrate    find the string lengths at which the encoders are zero
  --help
  --version

spidarctl COMMAND --help says more.
)";

int run(int argc, char** argv) {
  const std::string name = argc > 1 ? argv[1] : "";
  std::string known;
  for (const Command& command : kCommands) {
    if (name == command.name) return command.run(argc - 1, argv + 1);
    known += (known.empty() ? "" : ", ") + std::string(command.name);
  }
  if (name == "--version") {
    std::cout << "spidarctl " SPIDAR_VERSION "\n";
    return kDone;
  }
  if (name == "--help") {
    std::cout << kHelp;
    return kDone;
  }
  throw UsageError((name.empty() ? "no command" : name + " is not a command") + "; commands are " +
                   known);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const UsageError& error) {
    std::cerr << "spidarctl: " << error.what() << "; see spidarctl --help\n";
    return kWrongUsage;
  } catch (const std::exception& error) {
    std::cerr << "spidarctl: " << error.what() << '\n';
    return kFailed;
  }
}
