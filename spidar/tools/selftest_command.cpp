// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <iostream>
#include <string>

#include "spidar/profiles/profile_writer.h"
#include "spidar/tools/chosen_device.h"
#include "spidar/tools/commands.h"
#include "spidar/tools/selftest_report.h"
#include "spidar/tools/sim_wiring.h"
#include "spidar/tools/terminal.h"
#include "spidar/wiring/wiring_answers.h"
#include "spidar/wiring/wiring_report.h"

namespace spidar {
namespace {

constexpr const char* kHelp = R"(usage: spidarctl selftest DEVICE [OPTION]...

Pulls one string after the other, for a second each, or longer if the hand moves. From the responses
of the encoders, it determines which motor and which encoder are connected to which string, and which
of them are reversed. Hold the grip loosely at the centre.

  --newton N             tension of a pull above the minimum tension, 0.1 to 2 (default 0.5)
  --write-profile FILE.toml
                         write a profile that matches the wiring, if a profile can express it:
                         signs, and strings whose motor and encoder are at another channel
  --yes                  do not ask for confirmation
  --profile NAME         profile of the device, a name or a file
  --json                 print the report as JSON
  --sim-wiring FAULTS    simulated device: apply these wiring faults, for example
                         "swap-motors:1,2;reverse-encoder:4"; also swap-encoders, swap-strings,
                         reverse-motor, cut-motor, cut-encoder
  --help

Exit status: 0 the wiring is as in the profile, 1 it is not, or not confirmed, or no device, 2 wrong
usage, 130 interrupted.
)";

struct SelftestOptions {
  DeviceOptions common;
  double newton = 0.5;
  std::string output;
  std::string sim_wiring;
  bool yes = false;
  bool json = false;
};

SelftestOptions parse(int argc, char** argv) {
  SelftestOptions options;
  options.common =
      parse_device_options(argc, argv,
                           {{"newton", true,
                             [&](const std::string& text) {
                               options.newton = parse_number("--newton", text, 0.1, 2, "N");
                             }},
                            {"write-profile", true,
                             [&](const std::string& text) {
                               options.output = parse_profile_file("--write-profile", text);
                             }},
                            {"yes", false, [&](const std::string&) { options.yes = true; }},
                            json_option(options.json),
                            sim_wiring_option(options.sim_wiring)});
  return options;
}

void write(const SelftestOptions& options, const Profile& profile, const WiringReport& report) {
  if (!report.fixable()) {
    std::cerr << options.output << " is not written: a profile cannot express this wiring\n";
    return;
  }
  const Profile rewired = rewired_profile(profile, report, "spidarctl selftest");
  save_profile(rewired, options.output);
  std::cerr << "written: " << options.output << '\n';
  if (profile.calibration && !rewired.calibration)
    std::cerr << "the counts must be calibrated again: spidarctl calibrate\n";
}

}  // namespace

int selftest_command(int argc, char** argv) {
  const SelftestOptions options = parse(argc, argv);
  if (options.common.help) {
    std::cout << kHelp;
    return kDone;
  }
  ChosenDevice chosen = choose_device(options.common);
  require_strings(chosen.board, "selftest");
  miswire(options.sim_wiring, options.common.device, chosen);
  if (!options.output.empty()) check_folder_of(options.output);
  if (!options.yes && !is_simulated(options.common.device) &&
      !confirm("Pull the strings of " + chosen.device->name() +
               " one after the other? The grip will move; hold it loosely at the centre.")) {
    std::cerr << "nothing was pulled\n";
    return kFailed;
  }
  catch_signals();
  WiringTestSettings settings;
  settings.pull_N = options.newton;
  settings.try_reversed = can_reverse(options.common.device, chosen.profile);
  const WiringAnswers answers =
      ask_wiring(*chosen.device, chosen.profile, every_millisecond(), settings);
  if (!answers.complete) {
    std::cerr << "interrupted; the strings are released\n";
    return kInterrupted;
  }
  const WiringReport report = judge_wiring(chosen.profile, answers);
  (options.json ? print_wiring_json : print_wiring)(std::cout, chosen.profile, answers, report);
  if (!options.output.empty()) write(options, chosen.profile, report);
  return report.as_profile() ? kDone : kFailed;
}

}  // namespace spidar
