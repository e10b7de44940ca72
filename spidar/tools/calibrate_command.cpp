// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>
#include <optional>
#include <unistd.h>
#include <utility>

#include "core/json_text.h"
#include "spidar/calibration/calibration.h"
#include "spidar/calibration/samples.h"
#include "spidar/devices/sim/grip_model.h"
#include "spidar/devices/sim/simulated_device.h"
#include "spidar/profiles/profile_file.h"
#include "spidar/realtime/monotonic.h"
#include "spidar/selftest/selftest_report.h"
#include "spidar/selftest/wiring_report.h"
#include "spidar/session/device_factory.h"
#include "spidar/session/profile_choice.h"
#include "spidar/text.h"
#include "spidar/tools/device_command.h"
#include "spidar/tools/pull_rows.h"

namespace spidar::tools {
namespace {

constexpr int kNotCalibrated = 3;
constexpr double kHoldSeconds = 2;
constexpr double kSamplePeriod_s = 0.002;

struct CalibrateOptions : DeviceOptions {
  bool centre = false;
  std::optional<double> seconds;  ///< how long to move the grip; none: not named
  std::string free;               ///< empty, "exits", "scale" or "exits,scale"
  OutputFile output;

  double move_s() const { return seconds.value_or(20); }
  bool frees(const char* name) const { return free.find(name) != std::string::npos; }
};

void check_together(const CalibrateOptions& options) {
  if (options.centre && options.seconds) {
    throw UsageError("--centre and --move exclude each other; give one of them");
  }
  if (options.centre && !options.free.empty()) {
    throw UsageError("--free needs --move: a grip that is held still determines only the offsets");
  }
}

/// The device to calibrate and, if it is simulated, its hand.
class CalibratedDevice {
 public:
  CalibratedDevice(const CalibrateOptions& options, const Profile& profile)
      : geometry_(profile.geometry) {
    if (options.device != "sim") {
      // Offsets refer to the board's own counters.
      boards::Settings as_counted;
      as_counted.count_zero = boards::CountZero::kNever;
      device_ = make_device(options.device, profile, as_counted);
      return;
    }
    auto simulated = std::make_unique<SimulatedDevice>(profile, SimulatedDevice::Time::kClock);
    hand_ = simulated.get();
    device_ = std::move(simulated);
  }

  StringDevice& device() { return *device_; }

  void move_hand(double time_s) {
    if (hand_) hand_->set_hand(calibration::hand_in_motion(geometry_, time_s));
  }

 private:
  StringGeometry geometry_;
  std::unique_ptr<StringDevice> device_;
  SimulatedDevice* hand_ = nullptr;
};

class Progress {
 public:
  explicit Progress(double seconds) : seconds_(seconds), is_terminal_(isatty(STDERR_FILENO) != 0) {}
  ~Progress() {
    if (is_terminal_ && last_ >= 0) std::fputc('\n', stderr);
  }

  void show(double time_s) {
    const int left = static_cast<int>(std::ceil(std::max(0.0, seconds_ - std::max(0.0, time_s))));
    if (left == last_) return;
    last_ = left;
    std::fprintf(stderr, is_terminal_ ? "\r%4d s left " : "%4d s left\n", left);
  }

 private:
  double seconds_;
  bool is_terminal_;  ///< a terminal shows the progress in one line
  int last_ = -1;
};

/// Returns false, with a message, when the wiring differs from the profile, or when interrupted.
bool is_wired_right(const CalibrateOptions& options, const Profile& profile,
                    CalibratedDevice& calibrated) {
  bool has_printed = false;
  const selftest::Pace pace = [&, next = every_millisecond()] {
    // Only an open device can be described.
    if (!std::exchange(has_printed, true)) {
      std::cerr << "Hold the grip loosely at the centre. The strings are pulled one after the "
                   "other.\n";
    }
    return next();
  };
  selftest::WiringSettings settings;
  settings.try_reversed = can_reverse(options.device, profile);
  const auto [answers, report] = [&] {
    PullRows rows(profile.geometry.count);
    settings.pulled = rows.pulled();
    return selftest::test_wiring(calibrated.device(), profile, pace, settings,
                                 selftest::print_hold_still);
  }();
  if (!answers.complete) return false;
  if (report.as_profile()) return true;
  selftest::print_wiring(std::cerr, profile, answers, report);
  std::cerr << "nothing is calibrated: spidarctl selftest finds out what to change\n";
  return false;
}

calibration::CountSamples record(const CalibrateOptions& options, const Profile& profile,
                                 CalibratedDevice& calibrated) {
  const double seconds = options.centre ? kHoldSeconds : options.move_s();
  Progress progress(seconds);
  std::optional<double> begin_s;
  const auto next_tick = [&](double time_s) {
    if (!begin_s) {
      // Only an open device can be described.
      std::cerr
          << (options.centre
                  ? std::string("Hold the grip still at the centre, without turning it.\n")
                  : "Begin at the centre. Move and turn the grip in every direction, as far as it "
                    "goes, for " +
                        as_text(seconds) + " s.\n");
      begin_s = 1e-9 * static_cast<double>(monotonic_now_ns()) - time_s;
    }
    sleep_until_ns(static_cast<int64_t>(1e9 * (*begin_s + time_s)));
    if (!options.centre) calibrated.move_hand(time_s);
    progress.show(time_s);
    return !interrupted();
  };
  return calibration::record_counts(calibrated.device(), profile, seconds, kSamplePeriod_s,
                                    next_tick);
}

std::string how(const CalibrateOptions& options) {
  return options.centre ? "spidarctl calibrate: grip held at the centre"
                        : "spidarctl calibrate: grip moved for " + as_text(options.move_s()) + " s";
}

std::string triple(const Eigen::Vector3d& value, const char* pattern) {
  std::string text;
  for (int axis = 0; axis < 3; ++axis) text += (axis ? " " : "") + formatted(pattern, value[axis]);
  return text;
}

std::pair<const char*, const char*> text_of(calibration::Status status) {
  switch (status) {
    case calibration::Status::kSolved:
      return {"solved", ""};
    case calibration::Status::kUndetermined:
      return {"undetermined",
              "This motion does not determine everything that was asked for. Move further, turn "
              "the grip about every axis as well, take longer, or ask for less with --free.\n"};
    case calibration::Status::kContradiction:
      return {"contradiction",
              "The lengths contradict each other or the profile. Check that no string slips or is "
              "off its pulley and that the profile is correct, try --free exits,scale, or begin "
              "closer to the centre.\n"};
  }
  return {};
}

void print_result(const Profile& profile, const calibration::Result& result,
                  const std::string& how) {
  constexpr double kDegrees = 180 / M_PI;
  const auto [status, advice] = text_of(result.status);
  std::cout << profile.name << ": " << how << ", " << result.samples << " samples: " << status
            << "\n  counters zero at  " << triple(1e3 * result.cleared_at.position_m, "%.2f")
            << " mm, turned by "
            << triple(kDegrees * rotation_vector(result.cleared_at.orientation), "%.2f")
            << " deg\n  residual          " << formatted("%.2f um rms", 1e6 * result.residual_m)
            << "\n  grip moved        " << triple(1e3 * result.moved_m, "%.1f")
            << " mm each way, turned " << triple(kDegrees * result.turned_rad, "%.1f") << " deg\n";
  std::cout << "\n  string  offset mm\n";
  for (int i = 0; i < profile.geometry.count; ++i) {
    std::cout << formatted("  %6d  %9.4f\n", i, 1e3 * result.home_offset_m[i]);
  }
  if (result.estimated.free_scale) std::cout << formatted("\n  scale   %.6f\n", result.scale);
  if (result.estimated.free_exits) std::cout << "\n  exit    x y z mm\n";
  for (int i = 0; result.estimated.free_exits && i < profile.geometry.count; ++i) {
    std::cout << formatted("  %4d    %s\n", i,
                           triple(1e3 * result.exit_m[static_cast<size_t>(i)], "%8.3f").c_str());
  }
  std::cout << (*advice ? "\n" : "") << advice;
}

Json result_json(const Profile& profile, const calibration::Result& result,
                 const std::string& how) {
  const int strings = profile.geometry.count;
  Json json{{"profile", profile.name},
            {"how", how},
            {"status", text_of(result.status).first},
            {"samples", result.samples},
            {"residual_m", result.residual_m},
            {"home_offset_m", json_array(result.home_offset_m.head(strings))},
            {"cleared_at_m", json_array(result.cleared_at.position_m)},
            {"cleared_at_rad", json_array(rotation_vector(result.cleared_at.orientation))},
            {"moved_m", json_array(result.moved_m)},
            {"turned_rad", json_array(result.turned_rad)}};
  if (result.estimated.free_scale) json["scale"] = result.scale;
  for (size_t i = 0; result.estimated.free_exits && i < static_cast<size_t>(strings); ++i) {
    json["exit_m"].push_back(json_array(result.exit_m[i]));
  }
  return json;
}

int calibrate_command(const CalibrateOptions& options) {
  check_together(options);
  const DeviceInfo board = board_info(options.device);
  require_strings(board, "calibrate");
  const Profile profile = profile_for(options.device, options.profile);
  options.output.check();
  CalibratedDevice calibrated(options, profile);
  if (!may_move(options.device, options.yes,
                "Pull the strings of " + options.device +
                    " one after the other, then all of them taut? The grip will move; hold it "
                    "loosely at the centre.")) {
    return kFailed;
  }
  catch_signals();
  const bool wired_right = is_wired_right(options, profile, calibrated);
  if (!wired_right && !interrupted()) return kNotCalibrated;
  const calibration::CountSamples counts =
      wired_right ? record(options, profile, calibrated) : calibration::CountSamples();
  if (interrupted()) {
    std::cerr << "interrupted; the strings are released\n";
    return kInterrupted;
  }

  calibration::Settings settings;
  settings.free_exits = options.frees("exits");
  settings.free_scale = options.frees("scale");
  const calibration::Result result = options.centre
                                         ? calibration::calibrate_at_centre(profile, counts)
                                         : calibration::calibrate(profile, counts, settings);
  if (options.json) {
    std::cout << json_text(result_json(profile, result, how(options)), 2) << '\n';
  } else {
    print_result(profile, result, how(options));
  }
  if (result.status != calibration::Status::kSolved) return kNotCalibrated;
  if (options.output) {
    save_profile(calibration::calibrated_profile(profile, result, how(options)),
                 options.output.path);
    std::cerr << "written: " << options.output.path << '\n';
  }
  return kDone;
}

}  // namespace

void add_calibrate(Program& program) {
  const auto [app, options] =
      add_command(program, "calibrate",
                  "determine the string lengths at which the encoders are zero", calibrate_command);
  add_device(app, options);
  app.add_option("--move", options.seconds,
                 "you move and turn the grip in every direction for this long (default 20)")
      ->check(number(1, 600, " s"));
  app.add_flag("--centre", options.centre,
               "you hold the grip still at the centre, without turning it");
  app.add_option("--free", options.free,
                 "with --move, also determine where the strings leave the frame (exits), and a "
                 "factor on every metres_per_count (scale)")
      ->check(CLI::IsMember({"exits", "scale", "exits,scale", "scale,exits"}));
  add_profile_file(app, "--output", options.output, "write the calibrated profile");
  add_json(app, options.json);
  add_yes(app, options.yes);
  app.footer(
      "First the wiring is tested as selftest does, with pulls of 0.5 N, because counts of a\n"
      "device that is wired differently mean something else. Then the strings are held taut; no\n"
      "other force acts on the hand.\n\n"
      "Exit status: 0 calibrated, 1 device, profile or file not found or not usable, 2 wrong\n"
      "usage, 3 the wiring is not as in the profile, or the samples do not determine everything\n"
      "that was asked for or contradict the profile (nothing is written), 130 interrupted.");
}

}  // namespace spidar::tools
