// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Lists, inspects, tests and calibrates SPIDARs.

#include <vector>

#include "spidar/tools/command_line.h"
#include "spidar/tools/commands.h"

namespace {

using namespace spidar;

const std::vector<Command> kCommands = {
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

}  // namespace

int main(int argc, char** argv) {
  return run_program("spidarctl", kCommands, kHelp, argc, argv);
}
