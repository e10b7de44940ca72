// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Lists, inspects, tests and calibrates SPIDARs.
#include "spidar/realtime/standard_descriptors.h"
#include "spidar/tools/device_command.h"

int main(int argc, char** argv) {
  using namespace spidar;
  open_standard_descriptors();
  Program program;
  program.app.set_help_flag("-h,--help", "Explain the program, or a command, and end");
  program.app.set_version_flag("--version", "spidarctl " SPIDAR_VERSION);
  program.app.require_subcommand(1);
  program.app.footer("spidarctl COMMAND --help explains a command.");
  for (const auto add : {add_list, add_info, add_monitor, add_zero, add_pull, add_choose,
                         add_selftest, add_calibrate})
    add(program);
  return exit_status_of(program.app, [&] {
    check_command(program.app, argc, argv);
    program.app.parse(argc, argv);
    return program.status;
  });
}
