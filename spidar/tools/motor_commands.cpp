// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// spidarctl zero and pull.
#include <algorithm>
#include <iostream>

#include "core/json_text.h"
#include "spidar/loop/haptic_loop.h"
#include "spidar/profiles/encoder_scale.h"
#include "spidar/selftest/wiring_answers.h"
#include "spidar/text.h"
#include "spidar/tools/device_command.h"

namespace spidar::tools {
namespace {

struct PullOptions : DeviceOptions {
  int string = 0;
  double tension_N = 0;
  double seconds = 0;
};

int zero(const DeviceOptions& options) {
  ChosenDevice chosen = choose_device(options, Motors::kZeroed);
  bool answered = false;
  if (chosen.grip) {
    selftest::ForceHold hold(*chosen.grip, every_millisecond());
    hold.hold_for(0.02, [&](const GripReading&) { return answered = true; });
  } else {
    selftest::StringHold hold(*chosen.device, chosen.profile, every_millisecond());
    hold.hold_for(0.02, [&](const DeviceReading&) { return answered = true; });
  }
  if (!answered) {
    throw DeviceError(chosen.name() + ": the device did not answer; switch off its supply");
  }
  std::cout << chosen.name() << ": the motors are at zero\n";
  return kDone;
}

/// 5 N is the weight of half a kilogram on a finger. The heat of a motor also grows with time.
constexpr double kMaxPull_N = 5;
constexpr double kMaxPull_Ns = 5;
constexpr double kMaxPull_s = 10;

constexpr double kRamp_s = 0.1;

/// Throws UsageError when the profile does not allow this pull, or a hand should not get it.
void check_pull(const PullOptions& pull, const Profile& profile) {
  if (pull.string >= profile.geometry.count) {
    throw UsageError("STRING: " + std::to_string(pull.string) + " is not a number from 0 to " +
                     std::to_string(profile.geometry.count - 1));
  }
  const StringDrive& drive = profile.drives[static_cast<size_t>(pull.string)];
  const double most_N = std::max(std::min(drive.max_tension_N, kMaxPull_N), drive.min_tension_N);
  if (pull.tension_N < drive.min_tension_N || pull.tension_N > most_N) {
    throw UsageError(formatted("NEWTON: %g N, must be from %g to %g N", pull.tension_N,
                               drive.min_tension_N, most_N));
  }
  if (pull.tension_N > drive.min_tension_N && pull.tension_N * pull.seconds > kMaxPull_Ns) {
    throw UsageError(formatted(
        "SECONDS: %g N for %g s may hurt a hand or damage a motor: NEWTON times SECONDS must be "
        "at most %g; pull for %.2f s at most",
        pull.tension_N, pull.seconds, kMaxPull_Ns, kMaxPull_Ns / pull.tension_N));
  }
}

struct Lengths {
  StringVector before_m = StringVector::Zero(), pulled_m = StringVector::Zero();
  bool complete = false;

  StringVector change_m() const { return pulled_m - before_m; }
};

Lengths run(ChosenDevice& chosen, const PullOptions& pull) {
  const Profile& profile = chosen.profile;
  const EncoderScale encoders(profile);
  Lengths lengths;
  StringVector pulled_N = profile.min_tension_N();
  pulled_N[pull.string] = pull.tension_N;
  const auto newest = [&](StringVector& into) {
    return [&encoders, &into](const DeviceReading& reading) {
      into = encoders.lengths_m(reading.count);
      return true;
    };
  };
  selftest::StringHold hold(*chosen.device, profile, every_millisecond());
  lengths.complete = hold.ramp_to(profile.min_tension_N(), HapticLoop::kEnergise_s) &&
                     hold.hold_for(kRamp_s, newest(lengths.before_m)) &&
                     hold.ramp_to(pulled_N, kRamp_s) &&
                     hold.hold_for(pull.seconds, newest(lengths.pulled_m)) &&
                     hold.ramp_to(profile.min_tension_N(), kRamp_s);
  hold.release();
  return lengths;
}

void print(const PullOptions& pull, int strings, const Lengths& lengths) {
  const StringVector change_m = lengths.change_m();
  if (pull.json) {
    std::cout << json_text({{"string", pull.string},
                            {"tension_N", pull.tension_N},
                            {"seconds", pull.seconds},
                            {"length_m", json_array(lengths.pulled_m.head(strings))},
                            {"length_change_m", json_array(change_m.head(strings))}},
                           2)
              << '\n';
    return;
  }
  std::cout << formatted("string %d: %.2f N for %g s\nlengths changed by", pull.string,
                         pull.tension_N, pull.seconds);
  for (int i = 0; i < strings; ++i) std::cout << formatted(" %+.2f", 1e3 * change_m[i]);
  std::cout << " mm\n";
}

/// Returns why this was no pull; empty if the strings have answered. A string at its smallest
/// tension is pulled no more than before.
std::string why_no_pull(const PullOptions& pull, const Profile& profile, const Lengths& lengths) {
  if (pull.tension_N <= profile.drives[static_cast<size_t>(pull.string)].min_tension_N) return {};
  const StringVector change_m = lengths.change_m();
  const double least_m = selftest::smallest_answer_m(profile);
  const std::string string = std::to_string(pull.string);
  if (change_m.cwiseAbs().maxCoeff() < least_m) {
    return "no string has answered: switch on the supply of the motors, and check that string " +
           string + " is taut and that its motor and encoder are connected";
  }
  if (change_m[pull.string] > -least_m) {
    return "other strings have answered, but string " + string +
           " did not get shorter: spidarctl selftest finds what is exchanged or reversed";
  }
  return {};
}

int pull(const PullOptions& options) {
  require_strings(board_info(options.device), "pull");
  ChosenDevice chosen = choose_device(options, Motors::kPulled);
  check_pull(options, chosen.profile);
  if (!may_move(
          options.device, options.yes,
          formatted("Pull string %d of %s with %.2f N for %g s? The grip will move.",
                    options.string, chosen.name().c_str(), options.tension_N, options.seconds))) {
    return kFailed;
  }
  catch_signals();
  const Lengths lengths = in_real_time([&] { return run(chosen, options); });
  if (!lengths.complete) {
    std::cerr << "interrupted; the strings are released\n";
    return kInterrupted;
  }
  print(options, chosen.profile.geometry.count, lengths);
  const std::string why = why_no_pull(options, chosen.profile, lengths);
  if (!why.empty()) std::cerr << why << '\n';
  return why.empty() ? kDone : kFailed;
}

}  // namespace

void add_zero(Program& program) {
  const auto [app, options] = add_command(program, "zero", "set the motors to zero", zero);
  add_device(app, options);
  app.footer(
      "Sets every motor to zero volts at once. This is useful because a board keeps its last\n"
      "value when the program that drove it has ended. No profile is needed: one that is named "
      "with\n"
      "--profile is not read.");
}

void add_pull(Program& program) {
  const auto [app, options] = add_command(program, "pull", "pull one string", pull);
  add_device(app, options);
  app.add_option("STRING", options.string, "numbered from 0")
      ->required()
      ->check(CLI::Range(0, kMaxStrings - 1));
  app.add_option("NEWTON", options.tension_N, "tension of the string")
      ->required()
      ->check(number(0, kMaxPull_N, " N"));
  app.add_option("SECONDS", options.seconds, "how long it is pulled")
      ->required()
      ->check(number(0.01, kMaxPull_s, " s"));
  add_yes(app, options.yes);
  add_json(app, options.json);
  app.footer(
      "Pulls one string with NEWTON for SECONDS; the other strings keep their minimum tension.\n"
      "NEWTON must be from the smallest to the largest tension that the profile has for that\n"
      "string (spidarctl info DEVICE prints both; for the boards that have a driver, 1 to 5 N\n"
      "suits every shipped profile) and at most 5, which a hand can hold easily. NEWTON times\n"
      "SECONDS must be at most 5 (at the smallest tension, SECONDS at most 10), so that no motor\n"
      "gets hot.\n\n"
      "Exit status: 0 the string was pulled and has answered, 1 no device, no answer of the "
      "device\n"
      "or of the strings, or not confirmed, 2 wrong usage, 130 interrupted.");
}

}  // namespace spidar::tools
