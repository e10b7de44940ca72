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

#include "spidar/calibration/calibration.h"
#include "spidar/calibration/count_recorder.h"
#include "spidar/conformance/wiring_test.h"
#include "spidar/profiles/profile_writer.h"
#include "spidar/realtime/monotonic.h"
#include "spidar/session/device_factory.h"
#include "spidar/session/profile_choice.h"
#include "spidar/simulation/simulated_device.h"
#include "spidar/tools/calibrate_options.h"
#include "spidar/tools/calibrate_report.h"
#include "spidar/tools/chosen_device.h"
#include "spidar/tools/commands.h"
#include "spidar/tools/hand_motion.h"
#include "spidar/tools/selftest_report.h"
#include "spidar/tools/sim_wiring.h"
#include "spidar/tools/terminal.h"

namespace spidar {
namespace {

constexpr int kNotCalibrated = 3;
constexpr double kHoldSeconds = 2;
constexpr double kSamplePeriod_s = 0.002;

/// The device to calibrate and, if it is simulated, its hand.
class Bench {
 public:
  Bench(const CalibrateOptions& options, const Profile& profile) : geometry_(profile.geometry) {
    if (options.device != "sim") {
      // Offsets refer to the board's own counters.
      BoardSettings as_counted;
      as_counted.count_zero = CountZero::kNever;
      device_ = make_device(options.device, profile, as_counted);
      miswire(options.sim_wiring, options.device, profile, device_);
      return;
    }
    Profile real = profile;
    if (options.sim_start) {
      const StringVector offset_m =
          string_lengths_m(geometry_, *options.sim_start) - string_lengths_m(geometry_, {});
      for (int i = 0; i < geometry_.count; ++i)
        real.drives[static_cast<size_t>(i)].home_offset_m = offset_m[i];
    }
    auto simulated = std::make_unique<SimulatedDevice>(real, SimulatedDevice::Time::kClock);
    hand_ = simulated.get();
    device_ = std::move(simulated);
    miswire(options.sim_wiring, options.device, profile, device_);
  }

  Device& device() { return *device_; }

  void move_hand(double time_s) {
    if (hand_) hand_->set_hand(hand_in_motion(geometry_, time_s));
  }

 private:
  StringGeometry geometry_;
  std::unique_ptr<Device> device_;
  SimulatedDevice* hand_ = nullptr;
};

class Progress {
 public:
  explicit Progress(double seconds) : seconds_(seconds), shown_(isatty(STDERR_FILENO) != 0) {}
  ~Progress() {
    if (shown_ && last_ >= 0) std::fputc('\n', stderr);
  }

  void show(double time_s) {
    const int left = static_cast<int>(std::ceil(std::max(0.0, seconds_ - std::max(0.0, time_s))));
    if (!shown_ || left == last_) return;
    last_ = left;
    std::fprintf(stderr, "\r%4d s left ", left);
  }

 private:
  double seconds_;
  bool shown_;
  int last_ = -1;
};

/// False when it is not as in the profile, or when interrupted; says so.
bool is_wired_right(const CalibrateOptions& options, const Profile& profile, Bench& bench) {
  bool told = false;
  const Pace pace = [&, next = every_millisecond()] {
    // Only now is the device open.
    if (!std::exchange(told, true))
      std::cerr << "Hold the grip loosely at the centre. The strings are pulled one after the "
                   "other.\n";
    return next();
  };
  WiringTestSettings settings;
  settings.try_reversed = can_reverse(options.device, profile);
  const WiringTest test = test_wiring(bench.device(), profile, pace, settings, tell_to_hold_still);
  if (!test.answers.complete) return false;
  if (test.report.as_profile()) return true;
  print_wiring(std::cerr, profile, test.answers, test.report);
  std::cerr << "nothing is calibrated: spidarctl selftest finds out what to change\n";
  return false;
}

CountSamples record(const CalibrateOptions& options, const Profile& profile, Bench& bench) {
  const RecordingSettings settings{options.centre ? kHoldSeconds : options.seconds,
                                   kSamplePeriod_s};
  Progress progress(settings.seconds);
  std::optional<double> begin_s;
  const auto next_tick = [&](double time_s) {
    if (!begin_s) {
      // Only now is the device open.
      std::cerr << (options.centre
                        ? "Hold the grip still at the centre, without turning it.\n"
                        : "Move and turn the grip in every direction, as far as it goes.\n");
      begin_s = 1e-9 * static_cast<double>(monotonic_now_ns()) - time_s;
    }
    sleep_until_ns(static_cast<int64_t>(1e9 * (*begin_s + time_s)));
    if (!options.centre) bench.move_hand(time_s);
    progress.show(time_s);
    return !interrupted();
  };
  return record_counts(bench.device(), profile, settings, next_tick);
}

std::string how(const CalibrateOptions& options) {
  char text[64];
  std::snprintf(text, sizeof text, "spidarctl calibrate: grip moved for %g s", options.seconds);
  return options.centre ? "spidarctl calibrate: grip held at the centre" : text;
}

}  // namespace

int calibrate_command(int argc, char** argv) {
  const CalibrateOptions options = parse_calibrate_options(argc, argv);
  if (options.help) {
    std::cout << kCalibrateHelp;
    return kDone;
  }
  const BoardInfo board = board_info(options.device);
  require_strings(board, "calibrate");
  const Profile profile = profile_for(options.device, options.profile);
  if (!options.output.empty()) check_folder_of(options.output);
  catch_signals();
  Bench bench(options, profile);
  const bool wired_right = options.untested || is_wired_right(options, profile, bench);
  if (!wired_right && !interrupted()) return kNotCalibrated;
  const CountSamples counts = wired_right ? record(options, profile, bench) : CountSamples();
  if (interrupted()) {
    std::cerr << "interrupted; the strings are released\n";
    return kInterrupted;
  }

  const CalibrationResult result = options.centre ? calibrate_at_centre(profile, counts)
                                                  : calibrate(profile, counts, options.settings);
  (options.json ? print_result_json : print_result)(std::cout, profile, result, how(options));
  if (result.status != CalibrationStatus::kSolved) return kNotCalibrated;
  if (!options.output.empty()) {
    save_profile(calibrated_profile(profile, result, how(options)), options.output);
    std::cerr << "written: " << options.output << '\n';
  }
  return kDone;
}

}  // namespace spidar
