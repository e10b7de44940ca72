// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <cmath>
#include <iostream>
#include <limits>

#include "core/grip/pose_solver.h"
#include "core/json_text.h"
#include "spidar/devices/sim/grip_model.h"
#include "spidar/loop/haptic_loop.h"
#include "spidar/profiles/encoder_scale.h"
#include "spidar/text.h"
#include "spidar/tools/device_command.h"

namespace spidar::tools {
namespace {

struct MonitorOptions : DeviceOptions {
  bool taut = false;
  double seconds = std::numeric_limits<double>::infinity();
};

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

/// Shows lengths and pose, as the haptic loop computes them. For a board without a named profile,
/// shows the counts.
class Monitor {
 public:
  Monitor(const Profile& profile, bool json)
      : profile_(profile),
        encoders_(profile),
        solver_(profile.geometry, profile.max_pose_residual_m()),
        json_(json) {}

  void show(const DeviceReading& reading) {
    const StringVector lengths_m = encoders_.lengths_m(reading.count);
    const PoseResult result = solver_.solve(lengths_m);
    if (readings_++ % kReadingsPerLine != 0) return;
    const double time_s = 1e-9 * static_cast<double>(kTick_ns * (readings_ - 1));
    if (json_) {
      std::cout << json_text(json_of(time_s, reading, lengths_m, result)) << '\n';
    } else {
      print(time_s, reading, lengths_m, result);
    }
    std::cout << std::flush;
  }

 private:
  void print(double time_s, const DeviceReading& reading, const StringVector& lengths_m,
             const PoseResult& result) const {
    const bool counts = profile_.name.empty();
    if (readings_ == 1) {
      std::cout << (counts ? "     s  inputs  counts\n"
                           : "     s        x       y       z mm      rx      ry      rz deg  "
                             "inputs  mm\n");
    }
    std::cout << formatted("%6.1f  ", time_s);
    if (!counts) {
      const Eigen::Vector3d mm = 1e3 * result.pose.position_m;
      const Eigen::Vector3d deg = 180 / M_PI * rotation_vector(result.pose.orientation);
      std::cout << formatted("%7.2f %7.2f %7.2f     %7.2f %7.2f %7.2f      ", mm.x(), mm.y(),
                             mm.z(), deg.x(), deg.y(), deg.z());
    }
    std::cout << formatted("0x%04x ", reading.inputs);
    for (int i = 0; i < profile_.geometry.count; ++i) {
      std::cout << (counts ? formatted(" %8d", reading.count[static_cast<size_t>(i)])
                           : formatted(" %6.1f", 1e3 * lengths_m[i]));
    }
    if (!counts && result.status != PoseStatus::kSolved) {
      std::cout << "  " << pose_name(result.status);
    }
    if (!counts && result.faulty_string >= 0) {
      std::cout << "  string " << result.faulty_string << " does not fit";
    }
    std::cout << '\n';
  }

  Json json_of(double time_s, const DeviceReading& reading, const StringVector& lengths_m,
               const PoseResult& result) const {
    if (profile_.name.empty()) {
      return {{"time_s", time_s},
              {"inputs", reading.inputs},
              {"counts", std::vector<int32_t>(reading.count.begin(),
                                              reading.count.begin() + profile_.geometry.count)}};
    }
    return {{"time_s", time_s},
            {"position_m", json_array(result.pose.position_m)},
            {"rotation_rad", json_array(rotation_vector(result.pose.orientation))},
            {"pose", pose_name(result.status)},
            {"residual_m", result.residual_m},
            {"faulty_string", result.faulty_string},
            {"inputs", reading.inputs},
            {"length_m", json_array(lengths_m.head(profile_.geometry.count))}};
  }

  const Profile& profile_;
  const EncoderScale encoders_;
  PoseSolver solver_;
  const bool json_;
  int64_t readings_ = 0;
};

/// Prints how the board has answered, for the people who write its driver. Prints nothing for a
/// device without a link.
void print_link(const LinkHealth& health) {
  if (health.round_trip_max_ns == 0) return;
  std::cerr << formatted(
      "%llu exchanges answered in %lld us (median), %lld us (99 %%), %lld us at "
      "most; faults:",
      static_cast<unsigned long long>(health.count(LinkFault::kNone)),
      static_cast<long long>(health.round_trip_median_ns / 1000),
      static_cast<long long>(health.round_trip_p99_ns / 1000),
      static_cast<long long>(health.round_trip_max_ns / 1000));
  bool any = false;
  for (size_t i = 1; i < kLinkFaults; ++i) {
    if (health.faults[i] == 0) continue;
    std::cerr << (any ? ", " : " ") << health.faults[i] << ' '
              << to_string(static_cast<LinkFault>(i));
    any = true;
  }
  std::cerr << (any ? "\n" : " none\n");
}

int monitor(const MonitorOptions& options) {
  require_strings(board_info(options.device), "monitor");
  ChosenDevice chosen = choose_device(options, options.taut ? Motors::kPulled : Motors::kOff);
  if (options.taut &&
      !may_move(options.device, options.yes,
                "Pull all strings of " + chosen.name() + " taut? The grip may move.")) {
    return kFailed;
  }
  catch_signals();
  Monitor monitor(chosen.profile, options.json);
  selftest::StringHold hold(*chosen.device, chosen.profile, every_millisecond());
  if (options.taut) hold.ramp_to(chosen.profile.min_tension_N(), HapticLoop::kEnergise_s);
  hold.hold_for(options.seconds, [&](const DeviceReading& reading) {
    monitor.show(reading);
    return std::cout.good();  // a full disk ends the command
  });
  hold.release();
  print_link(chosen.device->health());
  return kDone;
}

}  // namespace

void add_monitor(Program& program) {
  const auto [app, options] =
      add_command(program, "monitor", "print the pose of the grip continuously", monitor);
  add_device(app, options);
  add_json(app, options.json);
  add_seconds(app, options.seconds);
  app.add_flag("--taut", options.taut, "keep the strings at their minimum tension");
  add_yes(app, options.yes);
  app.footer(
      "Prints the pose of the grip ten times a second: position (millimetres), rotation vector\n"
      "(degrees), inputs, string lengths (millimetres). The motors stay at zero, so strings may "
      "be\n"
      "slack. Of a board for which nobody has named a profile, prints the counts of the encoders\n"
      "instead. JSON is one object per line. At the end, it says on standard error how long the\n"
      "board took to answer, and which faults there were.");
}

}  // namespace spidar::tools
