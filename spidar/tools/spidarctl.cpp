// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Lists, inspects, tests and calibrates SPIDARs.

#include <vector>

#include "spidar/realtime/standard_descriptors.h"
#include "spidar/tools/command_line.h"
#include "spidar/tools/commands.h"

namespace {

using namespace spidar;

const std::vector<Command> kCommands = {
    {"list", list_command},
    {"info", info_command},
    {"monitor", monitor_command},
    {"rest", rest_command},
    {"zero", zero_command},
    {"pull", pull_command},
    {"choose", choose_command},
    {"selftest", selftest_command},
    {"conformance", conformance_command},
    {"calibrate", calibrate_command},
};

constexpr const char* kSpidarctlHelp = R"(usage: spidarctl COMMAND

  list         list devices and profiles
  info         identify a device and read it once
  monitor      print the pose of the grip continuously
  rest         hold the strings at their minimum tension
  zero         set the motors to zero
  pull         pull one string
  choose       confirm the profile of a board by moving the grip, and remember it
  selftest     find motors and encoders that are swapped or reversed
  conformance  test a board and write a report to send in
  calibrate    determine the string lengths at which the encoders are zero
  --help
  --version

spidarctl COMMAND --help describes the options of a command.
)";

}  // namespace

int main(int argc, char** argv) {
  open_standard_descriptors();
  return run_program("spidarctl", kCommands, kSpidarctlHelp, argc, argv);
}
