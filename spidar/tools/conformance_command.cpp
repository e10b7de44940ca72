// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <cmath>
#include <fstream>
#include <functional>
#include <future>
#include <iostream>
#include <optional>
#include <string>
#include <utility>

#include "spidar/conformance/delay_test.h"
#include "spidar/conformance/force_hold.h"
#include "spidar/conformance/wiring_test.h"
#include "spidar/loop/haptic_loop.h"
#include "spidar/realtime/monotonic.h"
#include "spidar/realtime/thread_setup.h"
#include "spidar/session/device_factory.h"
#include "spidar/tools/chosen_device.h"
#include "spidar/tools/commands.h"
#include "spidar/tools/conformance_report.h"
#include "spidar/tools/observed_grip.h"
#include "spidar/tools/selftest_report.h"
#include "spidar/tools/sim_wiring.h"
#include "spidar/tools/terminal.h"

namespace spidar {
namespace {

constexpr const char* kConformanceHelp = R"(usage: spidarctl conformance DEVICE [OPTION]...

Tests a board and writes a report that you can send in. The report contains the identification of
the board, the results of a thousand exchanges a second while you move the grip and press all
buttons, and, like selftest, the responses of the encoders to small pulls of each motor. If the
wiring is as in the profile, the grip is then shaken a little, and from how late it answers the
report says by how much the drives lag and how stiff a surface may be. It contains the board's
serial number and the kernel version of this system, but nothing else about you.

  --report FILE         write the report to FILE instead of standard output
  --seconds S           duration for which you move the grip, 0.1 to 600 (default 10)
  --newton N            tension of a pull above the minimum tension, 0.1 to 2 (default 0.5)
  --no-pull             leave the motors at zero all the time
  --shake N             largest force that shakes the grip, 0.1 to 1 (default 0.4)
  --shake-seconds S     seconds that are evaluated, 6 to 60 (default 12); each takes 1.6 s
  --no-shake            do not measure the lag of the drives
  --yes                 do not ask for confirmation
  --profile NAME        profile of the device, a name or a file
  --sim-wiring FAULTS   simulated device: see selftest
  --sim-lag MS          simulated device: its drives lag by this, 0 to 30 (default: drive_lag_s
                        of the profile)
  --help

Exit status: 0 the board conforms in everything that was tested, 1 it does not, or drive_lag_s of
the profile is too small, or there is no device, 2 wrong usage, 130 interrupted.
)";

struct ConformanceOptions {
  DeviceOptions common;
  double seconds = 10;
  double newton = 0.5;
  std::string report;
  std::string sim_wiring;
  std::optional<double> sim_lag_ms;
  DelayTestSettings shaking;
  bool pull = true;
  bool shake = true;
  bool yes = false;
};

ConformanceOptions parse(int argc, char** argv) {
  ConformanceOptions options;
  const auto number = [](const char* name, double& into, double min, double max, const char* unit) {
    return CommandOption{name, true, [=, &into](const std::string& text) {
                           into = parse_number(std::string("--") + name, text, min, max, unit);
                         }};
  };
  options.common = parse_device_options(
      argc, argv,
      {{"report", true, [&](const std::string& text) { options.report = text; }},
       number("seconds", options.seconds, 0.1, 600, "s"),
       number("newton", options.newton, 0.1, 2, "N"),
       number("shake", options.shaking.peak_N, 0.1, 1, "N"),
       {"shake-seconds", true,
        [&](const std::string& text) {
          options.shaking.periods = static_cast<int>(
              parse_number("--shake-seconds", text, DelayTestSettings::kFewestPeriods, 60, "s"));
        }},
       {"no-shake", false, [&](const std::string&) { options.shake = false; }},
       {"sim-lag", true,
        [&](const std::string& text) {
          options.sim_lag_ms = parse_number("--sim-lag", text, 0, 30, "ms");
        }},
       {"no-pull", false, [&](const std::string&) { options.pull = false; }},
       {"yes", false, [&](const std::string&) { options.yes = true; }},
       sim_wiring_option(options.sim_wiring)});
  return options;
}

/// The motors may be energised.
bool may_pull(const ConformanceOptions& options, const ChosenDevice& chosen) {
  if (!options.pull) return false;
  return options.yes || is_simulated(options.common.device) ||
         confirm("Hold the strings of " + chosen.board.device +
                 " taut while you move the grip, then pull one after the other" +
                 (options.shake
                      ? ", and shake the grip with up to " + shown(options.shaking.peak_N) +
                            " N for " + shown(std::round(options.shaking.most_seconds())) + " s"
                      : "") +
                 "? The grip will move. If you answer no, the motors stay at zero.");
}

/// False when interrupted.
bool watch(Device& device, const Profile& profile, double seconds, bool taut) {
  StringHold hold(device, profile, every_millisecond());
  std::cerr << "Move and turn the grip in every direction, and press all buttons, for " << seconds
            << " s.\n";
  const bool complete =
      (!taut || hold.go(profile.min_tension_N(), HapticLoop::kEnergise_s)) && hold.stay(seconds);
  hold.release();
  return complete;
}

bool watch(Grip& grip, double seconds) {
  std::cerr << "Move the grip in every direction for " << seconds << " s.\n";
  return ForceHold(grip, every_millisecond()).stay(seconds);
}

/// False when interrupted.
bool pull(Device& device, const ConformanceOptions& options, Conformance& found) {
  std::cerr << "Hold the grip loosely at the centre. The strings are pulled one after the other.\n";
  WiringTestSettings settings;
  settings.pull_N = options.newton;
  settings.try_reversed = can_reverse(options.common.device, found.profile);
  const WiringTest test =
      test_wiring(device, found.profile, every_millisecond(), settings, tell_to_hold_still);
  found.answers = test.answers;
  if (found.answers.complete) found.wiring = test.report;
  return found.answers.complete;
}

/// False when interrupted. Forces that a wrong wiring would turn round are not tried.
bool shake(Device& device, const ConformanceOptions& options, Conformance& found) {
  if (!options.shake || !found.wiring || !found.wiring->as_profile()) return true;
  std::cerr
      << "Hold the grip loosely at the centre, and still. It is shaken along the line of sight "
         "with up to "
      << options.shaking.peak_N << " N for " << std::round(options.shaking.seconds())
      << " s; Ctrl-C ends that.\n";
  // As the haptic loop runs: pauses of a busy machine cost seconds that are evaluated.
  std::packaged_task<DelayTest()> task([&] {
    request_exact_timers();
    request_real_time();
    return measure_delay(device, found.profile, every_millisecond(), monotonic_now_ns,
                         options.shaking);
  });
  std::future<DelayTest> result = task.get_future();
  start_thread("spidar-delay", std::move(task)).join();
  found.delay = result.get();
  return found.delay->complete;
}

void write(const std::string& file, const Conformance& found) {
  if (file.empty()) {
    print_conformance(std::cout, found, SPIDAR_VERSION);
    return;
  }
  std::ofstream out(file);
  print_conformance(out, found, SPIDAR_VERSION);
  if (!out.flush()) throw DeviceError(file + ": cannot be written");
  std::cerr << (found.conforms() ? "conforms" : "does not conform") << "; written: " << file
            << '\n';
}

/// `test` is false when interrupted.
int report(const ConformanceOptions& options, Conformance& found, const std::function<bool()>& test,
           const std::function<LinkHealth()>& health) {
  try {
    if (!test()) {
      std::cerr << "interrupted; the motors are at zero, and no report is written\n";
      return kInterrupted;
    }
  } catch (const DeviceError& error) {
    // What a report is for most of all.
    found.trouble = error.what();
    std::cerr << found.trouble << '\n';
  }
  found.health = health();
  write(options.report, found);
  return found.conforms() ? kDone : kFailed;
}

int test_strings(const ConformanceOptions& options, ChosenDevice& chosen) {
  if (options.sim_lag_ms) simulate_lag(1e-3 * *options.sim_lag_ms, options.common.device, chosen);
  miswire(options.sim_wiring, options.common.device, chosen.profile, chosen.device);
  const bool pulls = may_pull(options, chosen);
  catch_signals();
  ObservedDevice device(std::move(chosen.device));
  Conformance found{chosen.board, chosen.profile, device.seen(), {}, {}, {}, {}, {}};
  return report(
      options, found,
      [&] {
        return watch(device, chosen.profile, options.seconds, pulls) &&
               (!pulls || (pull(device, options, found) && shake(device, options, found)));
      },
      [&] { return device.health(); });
}

/// Of a joystick or mouse, the exchanges only.
int test_force(const ConformanceOptions& options, ChosenDevice& chosen) {
  if (options.sim_lag_ms) require_strings(chosen.board, "--sim-lag");
  if (!options.sim_wiring.empty()) require_strings(chosen.board, "--sim-wiring");
  catch_signals();
  ObservedGrip grip(std::move(chosen.grip));
  Conformance found{chosen.board, chosen.profile, grip.seen(), {}, {}, {}, {}, {}};
  return report(
      options, found, [&] { return watch(grip, options.seconds); }, [&] { return grip.health(); });
}

}  // namespace

int conformance_command(int argc, char** argv) {
  const ConformanceOptions options = parse(argc, argv);
  if (options.common.help) {
    std::cout << kConformanceHelp;
    return kDone;
  }
  ChosenDevice chosen =
      choose_device(options.common, options.pull ? Motors::kPulled : Motors::kOff);
  if (!options.report.empty()) check_folder_of(options.report);
  return chosen.grip ? test_force(options, chosen) : test_strings(options, chosen);
}

}  // namespace spidar
