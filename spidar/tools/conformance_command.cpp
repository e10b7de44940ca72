// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <cmath>
#include <functional>
#include <future>
#include <iostream>
#include <sstream>
#include <string>
#include <utility>

#include "spidar/conformance/conformance_report.h"
#include "spidar/conformance/delay_test.h"
#include "spidar/conformance/hold.h"
#include "spidar/conformance/observed_device.h"
#include "spidar/conformance/wiring_report.h"
#include "spidar/loop/haptic_loop.h"
#include "spidar/profiles/replace_file.h"
#include "spidar/realtime/monotonic.h"
#include "spidar/realtime/thread_setup.h"
#include "spidar/session/device_factory.h"
#include "spidar/tools/device_command.h"

namespace spidar {
namespace {

struct ConformanceOptions : DeviceOptions {
  double seconds = 10;
  double newton = 0.5;
  OutputFile report;
  DelayTestSettings shaking;
  bool no_pull = false, no_shake = false;
  bool yes = false;
};

/// The motors may be energised.
bool may_pull(const ConformanceOptions& options, const ChosenDevice& chosen) {
  if (options.no_pull) return false;
  return options.yes || is_simulated(options.device) ||
         confirm("Hold the strings of " + chosen.board.device +
                 " taut while you move the grip, then pull one after the other" +
                 (!options.no_shake
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
  settings.try_reversed = can_reverse(options.device, found.profile);
  const WiringTest test =
      test_wiring(device, found.profile, every_millisecond(), settings, tell_to_hold_still);
  found.answers = test.answers;
  if (found.answers.complete) found.wiring = test.report;
  return found.answers.complete;
}

/// False when interrupted. Forces that a wrong wiring would turn round are not tried.
bool shake(Device& device, const ConformanceOptions& options, Conformance& found) {
  if (options.no_shake || !found.wiring || !found.wiring->as_profile()) return true;
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
  std::ostringstream report;
  print_conformance(report, found, SPIDAR_VERSION);
  if (file.empty()) {
    std::cout << report.str();
    return;
  }
  replace_file(file, report.str());
  std::cerr << found.verdict() << "; written: " << file << '\n';
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
  write(options.report.path, found);
  return found.conforms() ? kDone : kFailed;
}

int test_strings(const ConformanceOptions& options, ChosenDevice& chosen) {
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
  catch_signals();
  ObservedGrip grip(std::move(chosen.grip));
  Conformance found{chosen.board, chosen.profile, grip.seen(), {}, {}, {}, {}, {}};
  return report(
      options, found, [&] { return watch(grip, options.seconds); }, [&] { return grip.health(); });
}

int conformance(const ConformanceOptions& options) {
  ChosenDevice chosen = choose_device(options, options.no_pull ? Motors::kOff : Motors::kPulled);
  options.report.check();
  return chosen.grip ? test_force(options, chosen) : test_strings(options, chosen);
}

}  // namespace

void add_conformance(Program& program) {
  const auto [app, options] = add_command(
      program, "conformance", "test a board and write a report to send in", conformance);
  add_device(app, options);
  add_output(app, "--report", options.report, "a file for the report, instead of standard output");
  app.add_option("--seconds", options.seconds, "for which you move the grip (default 10)")
      ->check(number(0.1, 600, " s"));
  app.add_option("--newton", options.newton,
                 "tension of a pull above the minimum tension (default 0.5)")
      ->check(number(0.1, 2, " N"));
  app.add_flag("--no-pull", options.no_pull, "leave the motors at zero all the time");
  app.add_option("--shake", options.shaking.peak_N,
                 "largest force that shakes the grip (default 0.4)")
      ->check(number(0.1, 1, " N"));
  app.add_option("--shake-seconds", options.shaking.periods,
                 "seconds that are evaluated (default 12); each takes 1.6 s")
      ->check(number(DelayTestSettings::kFewestPeriods, 60, " s"));
  app.add_flag("--no-shake", options.no_shake, "do not measure the lag of the drives");
  add_yes(app, options.yes);
  app.footer(
      "Tests a board and writes a report that you can send in. The report contains the\n"
      "identification of the board, the results of a thousand exchanges a second while you move\n"
      "the grip and press all buttons, and, like selftest, the responses of the encoders to small\n"
      "pulls of each motor. If the wiring is as in the profile, the grip is then shaken a little,\n"
      "and from how late it answers the report says by how much the drives lag and how stiff a\n"
      "surface may be. It contains the board's serial number and the kernel version of this\n"
      "system, but nothing else about you.\n\n"
      "Exit status: 0 the board conforms in everything that was tested, and every counter moved, "
      "1\n"
      "it does not, or drive_lag_s of the profile is too small, or there is no device, 2 wrong\n"
      "usage, 130 interrupted.");
}

}  // namespace spidar
