// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Options of `spidarctl calibrate`.
#pragma once

#include <optional>
#include <string>

#include "core/grip/pose.h"
#include "spidar/calibration/calibration.h"
#include "spidar/tools/command_line.h"

namespace spidar {

struct CalibrateOptions {
  std::string device;
  std::string profile;  ///< empty: that of the board
  bool centre = false;
  double seconds = 20;
  CalibrationSettings settings;
  std::string output;             ///< empty: none
  std::optional<Pose> sim_start;  ///< pose at which the simulated device's counters were cleared
  bool untested = false;          ///< does not test the wiring before
  std::string sim_wiring;
  bool json = false;
  bool help = false;
};

/// `argv[0]` is the name of the sub-command. Throws UsageError.
CalibrateOptions parse_calibrate_options(int argc, char** argv);

extern const char* const kCalibrateHelp;

}  // namespace spidar
