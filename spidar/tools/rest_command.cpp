// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <iostream>
#include <limits>

#include "spidar/loop/haptic_loop.h"
#include "spidar/tools/chosen_device.h"
#include "spidar/tools/commands.h"
#include "spidar/tools/terminal.h"

namespace spidar {
namespace {

constexpr const char* kRestHelp = R"(usage: spidarctl rest DEVICE [--seconds S] [--profile NAME]

Holds the strings at their minimum tension for S seconds, or until it is interrupted, and then
releases them by a ramp.
)";

}  // namespace

int rest_command(int argc, char** argv) {
  double seconds = std::numeric_limits<double>::infinity();
  const DeviceOptions options = parse_device_options(
      argc, argv, {{"seconds", true, [&](const std::string& text) {
                      seconds = parse_number("--seconds", text, 0.001, 86400, "s");
                    }}});
  if (options.help) {
    std::cout << kRestHelp;
    return kDone;
  }
  require_strings(board_info(options.device), "rest");
  ChosenDevice chosen = choose_device(options, Motors::kPulled);
  catch_signals();
  StringHold hold(*chosen.device, chosen.profile, every_millisecond());
  if (hold.go(chosen.profile.min_tension_N(), HapticLoop::kEnergise_s)) {
    std::cerr << chosen.device->name() << ": at rest\n";
    hold.stay(seconds);
  }
  hold.release();
  std::cerr << chosen.device->name() << ": the strings are released\n";
  return kDone;
}

}  // namespace spidar
