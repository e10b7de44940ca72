// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/conformance/wiring_text.h"

#include <algorithm>
#include <iostream>
#include <ostream>
#include <string>
#include <vector>

#include "spidar/conformance/wiring_report.h"

namespace spidar {
namespace {

/// Signs in a profile of the device as it is wired.
int motor_sign(const Profile& profile, const WiringReport& report, int i) {
  const auto k = static_cast<size_t>(i);
  return profile.drives[k].motor_sign * (report.channel[k].motor_reversed ? -1 : 1);
}

int encoder_sign(const Profile& profile, const WiringReport& report, int i) {
  const auto k = static_cast<size_t>(i);
  return profile.drives[k].encoder_sign * (report.channel[k].encoder_reversed ? -1 : 1);
}

/// Holds also after the plugs are put right, because a motor keeps its direction of rotation.
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

/// "strings 2 and 5 are swapped", or the place of each when more than two are exchanged.
template <typename StringOf>
void find_exchanges(const WiringReport& report, const std::string& things, const StringOf& of,
                    std::vector<std::string>& faults) {
  for (int i = 0; i < report.count; ++i) {
    const int j = of(i);
    if (j < 0 || j == i) continue;
    if (of(j) == i) {
      if (i < j)
        faults.push_back(things + "s " + std::to_string(i) + " and " + std::to_string(j) +
                         " are swapped");
    } else {
      faults.push_back(things + " " + std::to_string(i) + " is that of string " +
                       std::to_string(j));
    }
  }
}

std::vector<std::string> faults_of(const Profile& profile, const WiringReport& report) {
  std::vector<std::string> faults;
  const auto channel = [&](int i) -> const WiringChannel& {
    return report.channel[static_cast<size_t>(i)];
  };
  const auto motor = [&](int i) { return channel(i).motor_string; };
  const auto encoder = [&](int i) { return channel(i).encoder_string; };
  const auto both = [&](int i) { return motor(i) == encoder(i) ? motor(i) : i; };
  find_exchanges(report, "string", both, faults);
  find_exchanges(
      report, "motor", [&](int i) { return both(i) == i ? motor(i) : i; }, faults);
  find_exchanges(
      report, "encoder", [&](int i) { return both(i) == i ? encoder(i) : i; }, faults);
  for (int i = 0; i < report.count; ++i) {
    const std::string name = std::to_string(i);
    if (motor_reversed(profile, report, i)) faults.push_back("motor " + name + " is reversed");
    if (encoder_reversed(profile, report, i)) faults.push_back("encoder " + name + " is reversed");
    if (motor(i) < 0)
      faults.push_back("motor " + name +
                       " has no effect: it is disconnected, has no supply or is reversed, or its "
                       "string is slack");
    if (encoder(i) < 0)
      faults.push_back("encoder " + name +
                       " stands still: it is disconnected, or its string is slack");
  }
  return faults;
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
  if (!report.understood()) return "unclear";
  return report.as_profile() ? "as in the profile" : "not as in the profile";
}

}  // namespace

void tell_to_hold_still(const WiringReport& report) {
  const std::string motors = unclear_motors(report);
  std::cerr
      << "Unclear: " << (motors.empty() ? "all motors" : "motors" + motors)
      << ". Rest the elbow on the table, hold the grip with the fingertips, and let it be pulled "
         "without following or resisting. They are pulled again.\n";
}

void print_wiring(std::ostream& out, const Profile& profile, const WiringAnswers& answers,
                  const WiringReport& report) {
  out << "  channel  motor                encoder              own length mm\n";
  for (int i = 0; i < report.count; ++i) {
    const WiringChannel& c = report.channel[static_cast<size_t>(i)];
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
  if (report.understood())
    for (const std::string& fault : faults_of(profile, report)) out << fault << '\n';
  else if (silent(report))
    out << "No encoder moves, whichever motor pulls. Switch on the supply of the motors, and hold "
           "the grip so that the strings are taut.\n";
  else if (const std::string motors = unclear_motors(report); !motors.empty())
    out << "The responses of the encoders to pulls of these motors are unclear:" << motors
        << ". They have been pulled in " << WiringTest::kTries
        << " tries. Fix the grip at the centre so that it yields a little, for example with rubber "
           "bands, and test again. If the result is the same, check these motors and their "
           "strings.\n";
  else
    out << "No wiring of this profile explains the responses. Hold the grip still and loosely at "
           "the centre, and check the profile.\n";
  out << "wiring: " << verdict(report) << '\n';
}

Json wiring_json(const Profile& profile, const WiringAnswers& answers, const WiringReport& report) {
  Json channels = Json::array(), faults = Json::array();
  for (int i = 0; i < report.count; ++i) {
    const WiringChannel& c = report.channel[static_cast<size_t>(i)];
    channels.push_back({{"motor_string", c.motor_string},
                        {"unclear", c.unclear},
                        {"motor_sign", motor_sign(profile, report, i)},
                        {"encoder_string", c.encoder_string},
                        {"encoder_sign", encoder_sign(profile, report, i)},
                        {"own_length_change_m", own_answer_m(profile, answers, i)}});
  }
  if (report.understood()) faults = faults_of(profile, report);
  return {{"profile", profile.name},
          {"wiring", verdict(report)},
          {"correlation", report.correlation},
          {"fixable", report.fixable()},
          {"faults", faults},
          {"channels", channels}};
}

}  // namespace spidar
