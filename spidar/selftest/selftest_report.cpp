// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/selftest/selftest_report.h"

#include <algorithm>
#include <cstddef>
#include <iostream>
#include <ostream>
#include <string>

#include "spidar/grip/string_causes.h"
#include "spidar/loop/stiffness_limit.h"
#include "spidar/text.h"

namespace spidar::selftest {
namespace {

/// The signs that a profile must have for the device as it is wired.
int motor_sign(const Profile& profile, const WiringReport& report, int i) {
  const auto k = static_cast<size_t>(i);
  return profile.drives[k].motor_sign * (report.channel[k].motor_reversed ? -1 : 1);
}

int encoder_sign(const Profile& profile, const WiringReport& report, int i) {
  const auto k = static_cast<size_t>(i);
  return profile.drives[k].encoder_sign * (report.channel[k].encoder_reversed ? -1 : 1);
}

/// The result also holds after the plugs are corrected: a motor keeps its direction of rotation.
bool motor_reversed(const Profile& profile, const WiringReport& report, int i) {
  const int string = report.channel[static_cast<size_t>(i)].motor_string;
  return string >= 0 &&
         motor_sign(profile, report, i) != profile.drives[static_cast<size_t>(string)].motor_sign;
}

bool encoder_reversed(const Profile& profile, const WiringReport& report, int i) {
  const int string = report.channel[static_cast<size_t>(i)].encoder_string;
  return string >= 0 && encoder_sign(profile, report, i) !=
                            profile.drives[static_cast<size_t>(string)].encoder_sign;
}

std::string what(int string, bool reversed, int own, const char* verb, const char* silent) {
  if (string < 0) return silent;
  std::string text = string == own ? "" : std::string(verb) + std::to_string(string);
  if (reversed) text += text.empty() ? "reversed" : ", reversed";
  return text.empty() ? "ok" : text;
}

double own_answer_m(const Profile& profile, const WiringAnswers& answers, int i) {
  const StringDrive& drive = profile.drives[static_cast<size_t>(i)];
  return drive.encoder_sign * drive.metres_per_count * answers.counts(i, i);
}

bool silent(const WiringReport& report) {
  return std::all_of(report.channel.begin(), report.channel.begin() + report.count,
                     [](const WiringChannel& channel) { return channel.motor_string < 0; });
}

const char* verdict(const WiringReport& report) {
  if (silent(report)) return "no answer";
  if (!report.is_conclusive()) return "unclear";
  return report.as_profile() ? "as in the profile" : "not as in the profile";
}

}  // namespace

void print_hold_still(const WiringReport& report) {
  const std::string motors = unclear_motors(report);
  std::cerr
      << "Unclear: " << (motors.empty() ? "all motors" : "motors" + motors)
      << ". Rest the elbow on the table, hold the grip with the fingertips, and let it be pulled "
         "without following or resisting. They are pulled again.\n";
}

void print_wiring(std::ostream& out, const Profile& profile, const WiringAnswers& answers,
                  const WiringReport& report) {
  bool idle_motor = false, idle_encoder = false;
  out << "  channel  motor                encoder              own length mm\n";
  for (int i = 0; i < report.count; ++i) {
    const WiringChannel& c = report.channel[static_cast<size_t>(i)];
    idle_motor |= c.motor_string < 0;
    idle_encoder |= c.encoder_string < 0;
    out << formatted(
        "  %7d  %-20s %-20s %+.2f\n", i,
        c.unclear ? "unclear"
                  : what(c.motor_string, motor_reversed(profile, report, i), i, "pulls string ",
                         "nothing")
                        .c_str(),
        what(c.encoder_string, encoder_reversed(profile, report, i), i, "reads string ", "still")
            .c_str(),
        1e3 * own_answer_m(profile, answers, i));
  }
  out << '\n';
  if (silent(report)) {
    out << "No encoder moves, whichever motor pulls. Causes, the likeliest first: " << kStringCauses
        << ". Switch on the supply of the motors, and hold the grip so that the strings are "
           "taut.\n";
  } else if (report.is_conclusive()) {
    out << (idle_motor ? "nothing: the motor has no supply, its string is slack, or the motor is "
                         "reversed or disconnected\n"
                       : "")
        << (idle_encoder ? "still: its string is slack, or the encoder is disconnected\n" : "");
  } else if (const std::string motors = unclear_motors(report); !motors.empty()) {
    out << "The responses of the encoders to pulls of these motors are unclear:" << motors
        << ". They have been pulled in " << kWiringTries
        << " tries. Fix the grip at the centre so that it yields a little, for example with rubber "
           "bands, and test again. If the result is the same, check these motors and their "
           "strings.\n";
  } else {
    out << "No wiring of this profile explains the responses. Hold the grip still and loosely at "
           "the centre, and check the profile.\n";
  }
  out << "wiring: " << verdict(report) << '\n';
}

Json wiring_json(const Profile& profile, const WiringAnswers& answers, const WiringReport& report) {
  Json channels = Json::array();
  for (int i = 0; i < report.count; ++i) {
    const WiringChannel& c = report.channel[static_cast<size_t>(i)];
    channels.push_back({{"motor_string", c.motor_string},
                        {"unclear", c.unclear},
                        {"motor_sign", motor_sign(profile, report, i)},
                        {"encoder_string", c.encoder_string},
                        {"encoder_sign", encoder_sign(profile, report, i)},
                        {"own_length_change_m", own_answer_m(profile, answers, i)}});
  }
  return {{"profile", profile.name},
          {"wiring", verdict(report)},
          {"correlation", report.correlation},
          {"fixable", report.fixable()},
          {"channels", channels}};
}

void print_lag(std::ostream& out, const Profile& profile, const DelayTest& test,
               const LagVerdict& verdict) {
  if (!test.measured()) {
    out << "drive lag: not measured: " << test.error << '\n';
    return;
  }
  const LagFit& fit = *test.fit;
  out << formatted("drive lag: %.2f ms, standard error %.2f ms; from %.2f to %.2f ms (99.7 %%)\n",
                   1e3 * fit.lag_s, 1e3 * fit.error_s, 1e3 * fit.least_s, 1e3 * fit.most_s)
      << formatted("profile: drive_lag_s = %.4f; it has %g, %s\n", verdict.safe_lag_s,
                   profile.drive_lag_s,
                   verdict.stated_enough ? "which is enough" : "too small: surfaces may shake")
      << formatted("surfaces: %.0f N/m at most\n", most_stiffness_N_m(verdict.safe_lag_s));
}

Json lag_json(const DelayTest& test, const LagVerdict& verdict) {
  if (!test.measured()) return {{"error", test.error}};
  return {{"lag_s", test.fit->lag_s},
          {"least_s", test.fit->least_s},
          {"most_s", test.fit->most_s},
          {"drive_lag_s", verdict.safe_lag_s},
          {"profile_states_enough", verdict.stated_enough},
          {"most_stiffness_N_m", most_stiffness_N_m(verdict.safe_lag_s)}};
}

}  // namespace spidar::selftest
