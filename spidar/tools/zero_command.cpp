// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <iostream>

#include "spidar/conformance/force_hold.h"
#include "spidar/tools/chosen_device.h"
#include "spidar/tools/commands.h"
#include "spidar/tools/terminal.h"

namespace spidar {
namespace {

constexpr const char* kZeroHelp = R"(usage: spidarctl zero DEVICE [--profile NAME]

Sets every motor to zero volts at once. This is useful because a board keeps its last value when the
program that drove it has ended.
)";

}  // namespace

int zero_command(int argc, char** argv) {
  const DeviceOptions options = parse_device_options(argc, argv);
  if (options.help) {
    std::cout << kZeroHelp;
    return kDone;
  }
  ChosenDevice chosen = choose_device(options, Motors::kOff);
  bool answered = false;
  if (chosen.grip) {
    ForceHold hold(*chosen.grip, every_millisecond());
    hold.stay(0.02, [&](const GripReading&) { return answered = true; });
  } else {
    StringHold hold(*chosen.device, chosen.profile, every_millisecond());
    hold.stay(0.02, [&](const DeviceReading&) { return answered = true; });
  }
  if (!answered)
    throw DeviceError(chosen.name() + ": the device did not answer; switch off its supply");
  std::cout << chosen.name() << ": the motors are at zero\n";
  return kDone;
}

}  // namespace spidar
