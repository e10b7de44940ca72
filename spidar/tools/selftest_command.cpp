// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <array>
#include <iostream>
#include <string>

#include "spidar/conformance/conformance_report.h"
#include "spidar/conformance/stick_test.h"
#include "spidar/conformance/wiring_report.h"
#include "spidar/profiles/profile_writer.h"
#include "spidar/session/device_factory.h"
#include "spidar/tools/device_command.h"

namespace spidar {
namespace {

struct SelftestOptions : DeviceOptions {
  double newton = 0.5;
  OutputFile output;
  bool yes = false, json = false;
};

void write(const SelftestOptions& options, const Profile& profile, const WiringReport& report) {
  if (!report.fixable()) {
    std::cerr << options.output.path << " is not written: a profile cannot express this wiring\n";
    return;
  }
  const Profile rewired = rewired_profile(profile, report, "spidarctl selftest");
  save_profile(rewired, options.output.path);
  std::cerr << "written: " << options.output.path << '\n';
  if (profile.calibration && !rewired.calibration)
    std::cerr << "the counts must be calibrated again: spidarctl calibrate\n";
}

bool is_stick(const std::string& device) {
  return device == "ff" || device.compare(0, 3, "ff:") == 0;
}

const char* side_of(double moved_m) {
  if (moved_m >= StickTest::kLeast_m) return "moves with the force";
  return moved_m <= -StickTest::kLeast_m ? "moves against the force" : "does not move";
}

/// Advice for a stick whose driver pushes to the other side, or not at all.
void advise_on_stick(bool x, bool y) {
  const std::string sides = std::string(x ? "x" : "") + (y ? "y" : "");
  if (sides.empty())
    std::cout << "An axis that does not move is not tested. Let go of the stick, or try more "
                 "strength: ff:PATH,gain=50\n";
  else
    std::cout << "Its driver pushes to the other side. Write flip=" << sides
              << ": device=ff:PATH,flip=" << sides << '\n';
}

constexpr std::array<const char*, 3> kSides{"right  ", "up     ", "forward"};

/// Directions of a device that takes a force.
int test_push_command(const SelftestOptions& options, ChosenDevice& chosen) {
  const bool stick = is_stick(options.device);
  if (!may_move(options.device, options.yes,
                "Push " + chosen.name() + " to all sides with a part of its strength? " +
                    (stick ? "Take the hand away." : "Hold its grip loosely at the centre.")))
    return kFailed;
  catch_signals();
  const double push_N = stick ? chosen.grip->abilities().largest_force_N / 2 : options.newton;
  const StickTest test = test_stick(*chosen.grip, every_millisecond(), push_N);
  if (!test.complete) {
    std::cerr << "interrupted; the force is zero\n";
    return kInterrupted;
  }
  const GripAbilities can = chosen.grip->abilities();
  bool right = true;
  std::array<bool, 3> against{};
  for (size_t axis = 0; axis < kSides.size(); ++axis) {
    if (!can.force[axis]) continue;
    std::cout << kSides[axis] << "  " << side_of(test.moved_m[axis]) << '\n';
    right = right && test.moved_m[axis] >= StickTest::kLeast_m;
    against[axis] = test.moved_m[axis] <= -StickTest::kLeast_m;
  }
  if (stick && !right) advise_on_stick(against[0], against[1]);
  return right ? kDone : kFailed;
}

/// Whether it takes a force and says where it is.
bool answers_pushes(const ChosenDevice& chosen) {
  return chosen.grip && chosen.grip->abilities().position[0];
}

int selftest(const SelftestOptions& options) {
  ChosenDevice chosen = choose_device(options, Motors::kPulled);
  if (answers_pushes(chosen)) return test_push_command(options, chosen);
  require_strings(chosen.board, "selftest");
  options.output.check();
  if (!may_move(options.device, options.yes,
                "Pull the strings of " + chosen.name() +
                    " one after the other? The grip will move; hold it loosely at the centre."))
    return kFailed;
  catch_signals();
  WiringTestSettings settings;
  settings.pull_N = options.newton;
  settings.try_reversed = can_reverse(options.device, chosen.profile);
  const auto [answers, report] = test_wiring(*chosen.device, chosen.profile, every_millisecond(),
                                             settings, tell_to_hold_still);
  if (!answers.complete) {
    std::cerr << "interrupted; the strings are released\n";
    return kInterrupted;
  }
  if (options.json)
    std::cout << json_text(wiring_json(chosen.profile, answers, report));
  else
    print_wiring(std::cout, chosen.profile, answers, report);
  if (options.output) write(options, chosen.profile, report);
  return report.as_profile() ? kDone : kFailed;
}

}  // namespace

void add_selftest(Program& program) {
  const auto [app, options] = add_command(
      program, "selftest", "find motors and encoders that are swapped or reversed", selftest);
  add_device(app, options);
  app.add_option("--newton", options.newton,
                 "tension of a pull above the minimum tension, or force of a push (default 0.5)")
      ->check(number(0.1, 2, " N"));
  add_profile_file(app, "--write-profile", options.output,
                   "write a profile that matches the wiring, if a profile can express it: signs, "
                   "and strings whose motor and encoder are at another channel");
  add_yes(app, options.yes);
  add_json(app, options.json);
  app.footer(
      "Pulls one string after the other, for a second each, or longer if the hand moves. From the\n"
      "responses of the encoders, it determines which motor and which encoder are connected to\n"
      "which string, and which of them are reversed. Hold the grip loosely at the centre, with "
      "the\n"
      "elbow on the table. Motors whose responses are unclear, because the hand moved, are pulled\n"
      "again, up to twice.\n\n"
      "Of a Novint Falcon (falcon) or Haply Inverse3 (inverse3), determines whether it moves in\n"
      "the direction of the force: pushes it to each side for 0.2 s, four times. Hold its grip\n"
      "loosely at the centre. Of a joystick or wheel (ff), likewise, with half of the force that\n"
      "its gain allows. Take the hand away.\n\n"
      "Exit status: 0 the wiring is as in the profile, 1 it is not, or not confirmed, or no\n"
      "device, 2 wrong usage, 130 interrupted.");
}

}  // namespace spidar
