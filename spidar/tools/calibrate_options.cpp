// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/tools/calibrate_options.h"

#include <cmath>
#include <vector>

#include <Eigen/Geometry>

#include "spidar/tools/sim_wiring.h"

namespace spidar {

const char* const kCalibrateHelp =
    R"(usage: spidarctl calibrate DEVICE [OPTION]...

Determines the string lengths at which the encoders of DEVICE are zero.

  --profile NAME        profile of the device, a name or a file (default that of the board)
  --move SECONDS        you move and turn the grip in every direction (default, 20)
  --centre              you hold the grip still at the centre, without turning it
  --free exits,scale    with --move, also determine where the strings leave the frame, and a
                        factor on every metres_per_count
  --untested            do not test the wiring before
  --output FILE.toml    write the calibrated profile
  --json                print the report as JSON
  --sim-start X,Y,Z,RX,RY,RZ
                        simulated device: clear its counters X,Y,Z millimetres from the
                        centre, turned by RX,RY,RZ degrees (a rotation vector)
  --sim-wiring FAULTS   simulated device: see selftest
  --help

First the wiring is tested as selftest does, with pulls of 0.5 N, because counts of a device that is
wired differently mean something else. Then the strings are held taut; no other force acts on the
hand. Exit status: 0 calibrated, 1 device, profile or file not found or not usable, 2 wrong usage, 3
the wiring is not as in the profile, or the samples do not determine everything that was asked for or
contradict the profile (nothing is written), 130 interrupted.
)";

namespace {

CalibrationSettings free_parameters(const std::string& text) {
  CalibrationSettings settings;
  for (const std::string& part : split_at_commas(text)) {
    if (part != "exits" && part != "scale")
      throw UsageError("--free: \"" + part + "\" is unknown; known names are exits, scale");
    (part == "exits" ? settings.free_exits : settings.free_scale) = true;
  }
  return settings;
}

Pose start_pose(const std::string& text) {
  const std::vector<std::string> parts = split_at_commas(text);
  if (parts.size() != 6)
    throw UsageError("--sim-start: \"" + text +
                     "\" must be six numbers: X,Y,Z in millimetres, RX,RY,RZ in degrees");
  Eigen::Matrix<double, 6, 1> value;
  for (size_t i = 0; i < 6; ++i)
    value[static_cast<Eigen::Index>(i)] = parse_number("--sim-start", parts[i]);
  Pose pose;
  pose.position_m = 1e-3 * value.head<3>();
  const Eigen::Vector3d turn = M_PI / 180 * value.tail<3>();
  if (turn.norm() > 0) pose.orientation = Eigen::AngleAxisd(turn.norm(), turn.normalized());
  return pose;
}

void check_together(const CalibrateOptions& options, bool moving) {
  if (options.centre && moving)
    throw UsageError("--centre and --move exclude each other; give one of them");
  if (options.centre && (options.settings.free_exits || options.settings.free_scale))
    throw UsageError("--free needs --move: a grip that is held still determines only the offsets");
  if (options.sim_start && options.device != "sim")
    throw UsageError("--sim-start is for the device sim only, not for " + options.device);
}

}  // namespace

CalibrateOptions parse_calibrate_options(int argc, char** argv) {
  CalibrateOptions options;
  bool moving = false;
  const DeviceOptions given = parse_device_options(
      argc, argv,
      {{"move", true,
        [&](const std::string& text) {
          options.seconds = parse_number("--move", text, 1, 600, "s");
          moving = true;
        }},
       {"centre", false, [&](const std::string&) { options.centre = true; }},
       {"free", true, [&](const std::string& text) { options.settings = free_parameters(text); }},
       {"output", true,
        [&](const std::string& text) { options.output = parse_profile_file("--output", text); }},
       {"sim-start", true, [&](const std::string& text) { options.sim_start = start_pose(text); }},
       {"untested", false, [&](const std::string&) { options.untested = true; }},
       sim_wiring_option(options.sim_wiring),
       json_option(options.json)});
  options.help = given.help;
  options.device = given.device;
  options.profile = given.profile;
  if (!options.help) check_together(options, moving);
  return options;
}

}  // namespace spidar
