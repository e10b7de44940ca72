// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>

#include "spidar/conformance/wiring_answers.h"
#include "spidar/loop/haptic_loop.h"
#include "spidar/tools/chosen_device.h"
#include "spidar/tools/commands.h"
#include "spidar/tools/json_text.h"
#include "spidar/tools/readout.h"
#include "spidar/tools/terminal.h"

namespace spidar {
namespace {

constexpr const char* kPullHelp = R"(usage: spidarctl pull DEVICE STRING NEWTON SECONDS [OPTION]...

Pulls one string (numbered from 0) with NEWTON for SECONDS; the other strings keep their minimum
tension. NEWTON must be from the smallest to the largest tension that the profile has for that string
(`spidarctl info DEVICE` prints both; for the boards that have a driver, 1 to 5 N suits every shipped
profile) and at most 5, which a hand can hold easily. NEWTON times SECONDS must be at most 5 (at the
smallest tension, SECONDS at most 10), so that no motor gets hot.

  --yes           do not ask for confirmation
  --profile NAME  profile of the device, a name or a file
  --json          print the changes of the lengths as JSON

Exit status: 0 the string was pulled and has answered, 1 no device, no answer of the device or of the
strings, or not confirmed, 2 wrong usage, 130 interrupted.
)";

/// 5 N is the weight of half a kilogram hanging on a finger. The heat of a motor also grows with
/// time.
constexpr double kMaxPull_N = 5;
constexpr double kMaxPull_Ns = 5;
constexpr double kMaxPull_s = 10;

/// Duration of each ramp, up and down.
constexpr double kRamp_s = 0.1;

struct Pull {
  int string = 0;
  double tension_N = 0;
  double seconds = 0;
};

Pull parse(const DeviceOptions& options, const Profile& profile) {
  Pull pull;
  const double string =
      parse_number("STRING", options.operands[0], 0, profile.geometry.count - 1, "");
  if (string != std::floor(string))
    throw UsageError("STRING: " + options.operands[0] + " is not a whole number");
  pull.string = static_cast<int>(string);
  const StringDrive& drive = profile.drives[static_cast<size_t>(pull.string)];
  pull.tension_N =
      parse_number("NEWTON", options.operands[1], drive.min_tension_N,
                   std::max(std::min(drive.max_tension_N, kMaxPull_N), drive.min_tension_N), "N");
  pull.seconds = parse_number("SECONDS", options.operands[2], 0.01, kMaxPull_s, "s");
  if (pull.tension_N > drive.min_tension_N && pull.tension_N * pull.seconds > kMaxPull_Ns) {
    char text[160];
    std::snprintf(
        text, sizeof text,
        "SECONDS: %g N for %g s may hurt a hand or damage a motor: NEWTON times SECONDS must be "
        "at most %g; pull for %.2f s at most",
        pull.tension_N, pull.seconds, kMaxPull_Ns, kMaxPull_Ns / pull.tension_N);
    throw UsageError(text);
  }
  return pull;
}

struct Lengths {
  StringVector before_m = StringVector::Zero(), pulled_m = StringVector::Zero();
  bool complete = false;
};

Lengths run(ChosenDevice& chosen, const Pull& pull) {
  const Profile& profile = chosen.profile;
  const Readout readout(profile);
  Lengths lengths;
  StringVector pulled_N = profile.min_tension_N();
  pulled_N[pull.string] = pull.tension_N;
  const auto newest = [&](StringVector& into) {
    return [&readout, &into](const DeviceReading& reading) {
      into = readout.lengths_m(reading);
      return true;
    };
  };
  StringHold hold(*chosen.device, profile, every_millisecond());
  lengths.complete = hold.go(profile.min_tension_N(), HapticLoop::kEnergise_s) &&
                     hold.stay(kRamp_s, newest(lengths.before_m)) && hold.go(pulled_N, kRamp_s) &&
                     hold.stay(pull.seconds, newest(lengths.pulled_m)) &&
                     hold.go(profile.min_tension_N(), kRamp_s);
  hold.release();
  return lengths;
}

void print(const Pull& pull, const Profile& profile, const Lengths& lengths) {
  std::printf("string %d: %.2f N for %g s\nlengths changed by", pull.string, pull.tension_N,
              pull.seconds);
  for (int i = 0; i < profile.geometry.count; ++i)
    std::printf(" %+.2f", 1e3 * (lengths.pulled_m[i] - lengths.before_m[i]));
  std::printf(" mm\n");
}

void print_json(const Pull& pull, const Profile& profile, const Lengths& lengths) {
  const int count = profile.geometry.count;
  const StringVector change_m = lengths.pulled_m - lengths.before_m;
  std::cout << json_text(toml::table{{"string", pull.string},
                                     {"tension_N", pull.tension_N},
                                     {"seconds", pull.seconds},
                                     {"length_m", to_array(lengths.pulled_m.head(count))},
                                     {"length_change_m", to_array(change_m.head(count))}});
}

/// Why this was no pull; empty if the strings have answered. At its smallest tension, a string is
/// not pulled more than before.
std::string silence_of(const Pull& pull, const Profile& profile, const Lengths& lengths) {
  if (pull.tension_N <= profile.drives[static_cast<size_t>(pull.string)].min_tension_N) return {};
  const StringVector change_m = lengths.pulled_m - lengths.before_m;
  const double least_m = smallest_answer_m(profile);
  const std::string string = std::to_string(pull.string);
  if (change_m.cwiseAbs().maxCoeff() < least_m)
    return "no string has answered: switch on the supply of the motors, and check that string " +
           string + " is taut and that its motor and encoder are connected";
  if (change_m[pull.string] > -least_m)
    return "other strings have answered, but string " + string +
           " did not get shorter: spidarctl selftest finds what is exchanged or reversed";
  return {};
}

std::string question(const Pull& pull, const Device& device) {
  char text[160];
  std::snprintf(text, sizeof text, "Pull string %d of %s with %.2f N for %g s? The grip will move.",
                pull.string, device.name().c_str(), pull.tension_N, pull.seconds);
  return text;
}

}  // namespace

int pull_command(int argc, char** argv) {
  bool json = false, yes = false;
  const DeviceOptions options = parse_device_options(
      argc, argv, {{"yes", false, [&](const std::string&) { yes = true; }}, json_option(json)},
      {"STRING", "NEWTON", "SECONDS"});
  if (options.help) {
    std::cout << kPullHelp;
    return kDone;
  }
  require_strings(board_info(options.device), "pull");
  ChosenDevice chosen = choose_device(options, Motors::kPulled);
  const Pull pull = parse(options, chosen.profile);
  if (!yes && !confirm(question(pull, *chosen.device))) {
    std::cerr << "nothing was pulled\n";
    return kFailed;
  }
  catch_signals();
  const Lengths lengths = run(chosen, pull);
  if (!lengths.complete) {
    std::cerr << "interrupted; the strings are released\n";
    return kInterrupted;
  }
  if (json) {
    print_json(pull, chosen.profile, lengths);
  } else {
    print(pull, chosen.profile, lengths);
  }
  const std::string silence = silence_of(pull, chosen.profile, lengths);
  if (!silence.empty()) std::cerr << silence << '\n';
  return silence.empty() ? kDone : kFailed;
}

}  // namespace spidar
