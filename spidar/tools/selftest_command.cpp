// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <array>
#include <iostream>
#include <optional>
#include <string>

#include "core/grip/string_geometry.h"
#include "core/json_text.h"
#include "spidar/loop/haptic_loop.h"
#include "spidar/profiles/profile_file.h"
#include "spidar/realtime/monotonic.h"
#include "spidar/selftest/delay_test.h"
#include "spidar/selftest/hold.h"
#include "spidar/selftest/selftest_report.h"
#include "spidar/selftest/stick_test.h"
#include "spidar/selftest/wiring_report.h"
#include "spidar/session/device_factory.h"
#include "spidar/text.h"
#include "spidar/tools/device_command.h"
#include "spidar/tools/pull_rows.h"

namespace spidar::tools {
namespace {

struct SelftestOptions : DeviceOptions {
  double newton = 0.5;
  OutputFile output;
  bool lag = false;
};

/// `lag` has the measurement of the drives, if there was one.
void write(const SelftestOptions& options, const Profile& profile,
           const selftest::WiringReport& report, const std::optional<selftest::LagVerdict>& lag) {
  if (!report.fixable()) {
    std::cerr << options.output.path << " is not written: a profile cannot express this wiring\n";
    return;
  }
  Profile rewired = selftest::rewired_profile(profile, report, "spidarctl selftest");
  if (lag) {
    rewired.drive_lag_s = lag->safe_lag_s;
    rewired.drive_lag_known = true;
    rewired.provenance.push_back(
        {"drive_lag_s", "spidarctl selftest --lag", Evidence::kMeasured, ""});
  }
  save_profile(rewired, options.output.path);
  std::cerr << "written: " << options.output.path << '\n';
  if (profile.calibration && !rewired.calibration) {
    std::cerr << "the counts must be calibrated again: spidarctl calibrate\n";
  }
}

bool is_stick(const std::string& device) {
  return device == "ff" || device == "sim:ff" || device.compare(0, 3, "ff:") == 0;
}

const char* side_of(double moved_m) {
  if (moved_m >= selftest::StickTest::kMin_m) return "moves with the force";
  return moved_m <= -selftest::StickTest::kMin_m ? "moves against the force" : "does not move";
}

constexpr std::array<const char*, 3> kSides{"right  ", "up     ", "forward"};

/// Tests the directions of a device that takes a force.
int test_push_command(const SelftestOptions& options, ChosenDevice& chosen) {
  const bool stick = is_stick(options.device);
  if (!may_move(options.device, options.yes,
                "Push " + chosen.name() + " to all sides with a part of its strength? " +
                    (stick ? "Take the hand away." : "Hold its grip loosely at the centre."))) {
    return kFailed;
  }
  catch_signals();
  const double push_N = stick ? chosen.grip->abilities().largest_force_N / 2 : options.newton;
  const selftest::StickTest test =
      in_real_time([&] { return selftest::test_stick(*chosen.grip, every_millisecond(), push_N); });
  if (!test.complete) {
    std::cerr << "interrupted; the force is zero\n";
    return kInterrupted;
  }
  const GripAbilities can = chosen.grip->abilities();
  if (stick) {
    std::cout << test.description << '\n'
              << selftest::stick_report(test, can, half_picture_m(chosen.profile.geometry),
                                        options.device);
  }
  if (stick && is_simulated(options.device)) {
    std::cout << "This one is simulated, with a hand that holds it: nothing is wrong.\n";
  }
  bool right = true;
  for (size_t axis = 0; axis < kSides.size(); ++axis) {
    if (!can.force[axis]) continue;
    if (!stick) std::cout << kSides[axis] << "  " << side_of(test.moved_m[axis]) << '\n';
    right = right && test.moved_m[axis] >= selftest::StickTest::kMin_m;
  }
  return right ? kDone : kFailed;
}

/// Gives a pulse in each direction, or one if the device only has a strength. Returns the device's
/// description; nothing when interrupted.
std::optional<std::string> pulse(Grip& grip, double push_N) {
  constexpr double kRise_s = 0.05, kPulse_s = 0.5;
  const GripAbilities can = grip.abilities();
  selftest::ForceHold hold(grip, every_millisecond());
  const auto begin = [&] { return hold.ramp_to(Eigen::Vector3d::Zero(), HapticLoop::kEnergise_s); };
  bool whole = selftest::repeated(
      hold, [] { return true; }, begin);
  for (size_t axis = 0; axis < (can.direction ? kSides.size() : 1) && whole; ++axis) {
    if (!can.force[axis]) continue;
    std::cout << (can.direction ? kSides[axis] : "strength") << "  a pulse of 0.5 s" << std::endl;
    const Eigen::Vector3d along = Eigen::Vector3d::Unit(static_cast<Eigen::Index>(axis));
    whole = selftest::repeated(hold, begin, [&] {
      return hold.ramp_to(push_N * along, kRise_s) && hold.hold_for(kPulse_s) &&
             hold.ramp_to(Eigen::Vector3d::Zero(), kRise_s) && hold.hold_for(kPulse_s);
    });
  }
  return whole ? std::optional(grip.description()) : std::nullopt;
}

/// For a device that only rumbles or does not report its position: only a person knows whether and
/// where the pulses are felt.
int pulse_command(const SelftestOptions& options, ChosenDevice& chosen) {
  const double push_N = chosen.grip->abilities().largest_force_N / 2;
  if (!may_move(options.device, options.yes,
                formatted("Push %s with %.1f N, one direction after the other?",
                          chosen.name().c_str(), push_N))) {
    return kFailed;
  }
  catch_signals();
  const std::optional<std::string> felt = in_real_time([&] { return pulse(*chosen.grip, push_N); });
  if (!felt) {
    std::cerr << "interrupted; the force is zero\n";
    return kInterrupted;
  }
  std::cout << *felt << "\nThe device has taken them; only you know what was felt.\n";
  return kDone;
}

/// Whether the device moves where it is pushed, and reports it. Only an open device knows.
bool answers_pushes(Grip& grip) {
  grip.open();
  const GripAbilities can = grip.abilities();
  grip.close();
  return can.direction && can.position[0];
}

bool is_confirmed(const SelftestOptions& options, const std::string& device) {
  std::string question = "Pull the strings of " + device + " one after the other";
  if (options.lag) {
    question +=
        formatted(", and shake the grip with up to %g N for %.0f s",
                  selftest::DelaySettings().peak_N, selftest::DelaySettings().most_seconds());
  }
  return may_move(options.device, options.yes,
                  question + "? The grip will move; hold it loosely at the centre.");
}

selftest::DelayTest shake(StringDevice& device, const Profile& profile) {
  std::cerr << formatted(
      "Hold the grip loosely at the centre, and still. It is shaken along the line of sight with "
      "up "
      "to %g N for %.0f s; Ctrl-C ends that.\n",
      selftest::DelaySettings().peak_N, selftest::DelaySettings().seconds());
  return in_real_time([&] {
    return selftest::measure_delay(device, profile, every_millisecond(), monotonic_now_ns);
  });
}

int interrupted_test() {
  std::cerr << "interrupted; the strings are released\n";
  return kInterrupted;
}

int run_selftest(const SelftestOptions& options) {
  ChosenDevice chosen = choose_device(options, Motors::kPulled);
  if (chosen.grip) {
    return answers_pushes(*chosen.grip) ? test_push_command(options, chosen)
                                        : pulse_command(options, chosen);
  }
  require_strings(chosen.board, "selftest");
  options.output.check();
  if (!is_confirmed(options, chosen.name())) return kFailed;
  catch_signals();
  const Profile& profile = chosen.profile;
  selftest::WiringSettings settings;
  settings.pull_N = options.newton;
  settings.try_reversed = can_reverse(options.device, profile);
  const auto [answers, report] = [&] {
    PullRows rows(profile.geometry.count);
    settings.pulled = rows.pulled();
    return in_real_time([&] {
      return selftest::test_wiring(*chosen.device, profile, every_millisecond(), settings,
                                   selftest::print_hold_still);
    });
  }();
  if (!answers.complete) return interrupted_test();
  Json json;
  if (options.json) {
    json = selftest::wiring_json(profile, answers, report);
  } else {
    selftest::print_wiring(std::cout, profile, answers, report);
  }
  bool right = report.as_profile();
  std::optional<selftest::LagVerdict> lag;
  // The test does not exert forces that a wrong wiring would reverse.
  if (options.lag && right) {
    const selftest::DelayTest test = shake(*chosen.device, profile);
    if (!test.complete) return interrupted_test();
    if (test.measured()) {
      lag = selftest::judge_lag(profile, *test.fit, chosen.device->health().round_trip_p99_ns);
    }
    right = lag && lag->stated_enough;
    if (options.json) {
      json["drive_lag"] = selftest::lag_json(test, lag.value_or(selftest::LagVerdict()));
    } else {
      selftest::print_lag(std::cout, profile, test, lag.value_or(selftest::LagVerdict()));
    }
  }
  if (options.json) std::cout << json_text(json, 2) << '\n';
  if (options.output) write(options, profile, report, lag);
  return right ? kDone : kFailed;
}

}  // namespace

void add_selftest(Program& program) {
  const auto [app, options] = add_command(
      program, "selftest", "find motors and encoders that are swapped or reversed", run_selftest);
  add_device(app, options);
  app.add_option("--newton", options.newton,
                 "tension of a pull above the minimum tension, or force of a push (default 0.5)")
      ->check(number(0.1, 2, " N"));
  add_profile_file(
      app, "--write-profile", options.output,
      "write a profile that matches the wiring, if a profile can express it: signs, "
      "strings whose motor and encoder are at another channel, and with --lag the lag");
  app.add_flag("--lag", options.lag,
               "then shake the grip for 20 s, and find by how much the drives lag");
  add_yes(app, options.yes);
  add_json(app, options.json);
  app.footer(
      "Pulls one string after the other, for a second each, or longer if the hand moves. From the\n"
      "responses of the encoders, it determines which motor and which encoder are connected to\n"
      "which string, and which of them are reversed. Hold the grip loosely at the centre, with "
      "the\n"
      "elbow on the table. Motors whose responses are unclear, because the hand moved, are pulled\n"
      "again, up to twice.\n\n"
      "With --lag, and if the wiring is as in the profile, the grip is then shaken with at most\n"
      "0.4 N. From how late it answers follows the drive_lag_s that belongs into the profile, and\n"
      "how stiff a surface may be.\n\n"
      "Of a device without strings, determines whether it moves in the direction of the force:\n"
      "pushes it to each side for 0.2 s, four times. Hold its grip loosely at the centre. Of a\n"
      "joystick or wheel (ff), likewise, with half of the force that its gain allows, and whether\n"
      "a spring pulls it back although it is switched off. Take the hand away. A device without a\n"
      "position, such as a sound card, or that only rumbles, gets pulses, which only you can "
      "feel.\n\n"
      "Exit status: 0 the wiring is as in the profile, 1 it is not, or drive_lag_s is too small "
      "or\n"
      "was not found, or not confirmed, or no device, 2 wrong usage, 130 interrupted.");
}

}  // namespace spidar::tools
