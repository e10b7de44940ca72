// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <cmath>
#include <cstdio>
#include <iostream>
#include <limits>

#include "spidar/loop/haptic_loop.h"
#include "spidar/simulation/grip_model.h"
#include "spidar/tools/chosen_device.h"
#include "spidar/tools/commands.h"
#include "spidar/tools/json_text.h"
#include "spidar/tools/readout.h"
#include "spidar/tools/terminal.h"

namespace spidar {
namespace {

constexpr const char* kMonitorHelp = R"(usage: spidarctl monitor DEVICE [OPTION]...

Prints the pose of the grip ten times a second: position (millimetres), rotation vector (degrees),
inputs, string lengths (millimetres). The motors stay at zero, so strings may be slack. Of a board for
which nobody has named a profile, prints the counts of the encoders instead.

  --taut          keep the strings at their minimum tension
  --seconds S     end after S seconds; by default, run until interrupted
  --profile NAME  profile of the device, a name or a file
  --json          print one JSON object per line
)";

constexpr int kReadingsPerLine = 100;

const char* pose_name(PoseStatus status) {
  switch (status) {
    case PoseStatus::kSolved:
      return "solved";
    case PoseStatus::kNotConverged:
      return "no pose fits";
    case PoseStatus::kAmbiguous:
      return "ambiguous";
    case PoseStatus::kBadInput:
      return "bad length";
  }
  return "";
}

class Monitor {
 public:
  Monitor(const Profile& profile, bool json) : profile_(profile), readout_(profile), json_(json) {}

  void show(const DeviceReading& reading) {
    if (profile_.name.empty()) {
      show_counts(reading);
      return;
    }
    const StringVector lengths_m = readout_.lengths_m(reading);
    const PoseResult result = readout_.pose(lengths_m);
    if (readings_++ % kReadingsPerLine != 0) return;
    const double time_s = 1e-9 * static_cast<double>(kTick_ns * (readings_ - 1));
    (json_ ? json(time_s, reading, lengths_m, result) : text(time_s, reading, lengths_m, result));
    std::fflush(stdout);
  }

 private:
  void show_counts(const DeviceReading& reading) {
    if (readings_++ % kReadingsPerLine != 0) return;
    const double time_s = 1e-9 * static_cast<double>(kTick_ns * (readings_ - 1));
    if (json_) {
      toml::array counts;
      for (int i = 0; i < profile_.geometry.count; ++i)
        counts.push_back(reading.count[static_cast<size_t>(i)]);
      std::fputs(
          json_line(toml::table{{"time_s", time_s}, {"inputs", reading.inputs}, {"counts", counts}})
              .c_str(),
          stdout);
    } else {
      if (readings_ == 1) std::printf("     s  inputs  counts\n");
      std::printf("%6.1f  0x%04x ", time_s, reading.inputs);
      for (int i = 0; i < profile_.geometry.count; ++i)
        std::printf(" %8d", reading.count[static_cast<size_t>(i)]);
      std::printf("\n");
    }
    std::fflush(stdout);
  }

  void text(double time_s, const DeviceReading& reading, const StringVector& lengths_m,
            const PoseResult& result) const {
    if (readings_ == 1)
      std::printf("     s        x       y       z mm      rx      ry      rz deg  inputs  mm\n");
    const Eigen::Vector3d mm = 1e3 * result.pose.position_m;
    const Eigen::Vector3d deg = 180 / M_PI * rotation_vector(result.pose.orientation);
    std::printf("%6.1f  %7.2f %7.2f %7.2f     %7.2f %7.2f %7.2f      0x%04x ", time_s, mm.x(),
                mm.y(), mm.z(), deg.x(), deg.y(), deg.z(), reading.inputs);
    for (int i = 0; i < profile_.geometry.count; ++i) std::printf(" %6.1f", 1e3 * lengths_m[i]);
    if (result.status != PoseStatus::kSolved) std::printf("  %s", pose_name(result.status));
    if (result.faulty_string >= 0) std::printf("  string %d does not fit", result.faulty_string);
    std::printf("\n");
  }

  void json(double time_s, const DeviceReading& reading, const StringVector& lengths_m,
            const PoseResult& result) const {
    const std::string line = json_line(toml::table{
        {"time_s", time_s},
        {"position_m", to_array(result.pose.position_m)},
        {"rotation_rad", to_array(rotation_vector(result.pose.orientation))},
        {"pose", pose_name(result.status)},
        {"residual_m", result.residual_m},
        {"faulty_string", result.faulty_string},
        {"inputs", reading.inputs},
        {"length_m", to_array(lengths_m.head(profile_.geometry.count))},
    });
    std::fputs(line.c_str(), stdout);
  }

  const Profile& profile_;
  Readout readout_;
  const bool json_;
  int64_t readings_ = 0;
};

}  // namespace

int monitor_command(int argc, char** argv) {
  bool json = false, taut = false;
  double seconds = std::numeric_limits<double>::infinity();
  const DeviceOptions options =
      parse_device_options(argc, argv,
                           {{"taut", false, [&](const std::string&) { taut = true; }},
                            {"seconds", true,
                             [&](const std::string& text) {
                               seconds = parse_number("--seconds", text, 0.001, 86400, "s");
                             }},
                            json_option(json)});
  if (options.help) {
    std::cout << kMonitorHelp;
    return kDone;
  }
  require_strings(board_info(options.device), "monitor");
  ChosenDevice chosen = choose_device(options, taut ? Motors::kPulled : Motors::kOff);
  catch_signals();
  Monitor monitor(chosen.profile, json);
  StringHold hold(*chosen.device, chosen.profile, every_millisecond());
  if (taut) hold.go(chosen.profile.min_tension_N(), HapticLoop::kEnergise_s);
  hold.stay(seconds, [&](const DeviceReading& reading) {
    monitor.show(reading);
    return true;
  });
  hold.release();
  return kDone;
}

}  // namespace spidar
