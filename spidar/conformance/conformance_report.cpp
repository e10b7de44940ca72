// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/conformance/conformance_report.h"

#include <algorithm>
#include <ctime>
#include <iostream>
#include <ostream>
#include <sys/utsname.h>

#include "core/touch/contact_force.h"
#include "spidar/boards/link_thread.h"
#include "spidar/conformance/delay_test.h"
#include "spidar/loop/haptic_loop.h"

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
  if (silent(report))
    out << "No encoder moves, whichever motor pulls. Switch on the supply of the motors, and hold "
           "the grip so that the strings are taut.\n";
  else if (report.understood())
    out << (idle_motor ? "nothing: the motor is disconnected, has no supply or is reversed, or its "
                         "string is slack\n"
                       : "")
        << (idle_encoder ? "still: the encoder is disconnected, or its string is slack\n" : "");
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

namespace {

const char* of_profile(StatedLag stated) {
  switch (stated) {
    case StatedLag::kTooSmall:
      return "too small: surfaces may shake";
    case StatedLag::kRight:
      return "right";
    case StatedLag::kMore:
      return "more than is needed, which is safe";
  }
  return "";
}

/// Lag, t_d, the line for the profile, and the stiffness that is safe; or why there is no number.
void print_delay(std::ostream& out, const Profile& profile, const DelayTest& test, int late_ticks) {
  if (!test.measured()) {
    out << "drive lag   not measured: " << test.trouble << '\n';
    return;
  }
  const LagFit& fit = *test.fit;
  const LagVerdict verdict = judge_lag(profile, fit, late_ticks);
  out << formatted("drive lag   %.2f ms, standard error %.2f ms; from %.2f to %.2f ms (99.7 %%)\n",
                   1e3 * fit.lag_s, 1e3 * fit.error_s, 1e3 * fit.least_s, 1e3 * fit.most_s)
      << formatted(
             "moved       %.2f kg, %.1f N s/m, %.0f N/m, by %.1f mm at most; misfit %.1f; %d s\n",
             fit.mass_kg, fit.damping_N_s_m, fit.stiffness_N_m, 1e3 * test.moved_m, fit.misfit,
             test.periods);
  if (late_ticks > 0)
    out << formatted(
        "answers     some take longer than 0.7 ms and count %d ms later while playing, which "
        "is added below\n",
        late_ticks);
  out << formatted("delay       t_d = %.1f ms at most: 1.5 ms of the loop, %.1f ms of the drive\n",
                   1e3 * verdict.delay_s, 1e3 * verdict.safe_lag_s)
      << formatted("profile     drive_lag_s = %.4f; it has %g, %s\n", verdict.safe_lag_s,
                   profile.drive_lag_s, of_profile(verdict.stated))
      << formatted("stiffness   %.0f N/m at most, with a damping of %.1f K t_d = %.1f N s/m\n",
                   verdict.stiffness_N_m, ContactSettings().damping, verdict.damping_N_s_m);
}

/// In a word or two: "conforms", "does not conform: …", "not measured".
std::string delay_summary(const Profile& profile, const DelayTest& test, int late_ticks) {
  if (test.fault) return "does not conform: there was a fault while it was measured";
  if (!test.measured()) return "not measured";
  if (judge_lag(profile, *test.fit, late_ticks).stated != StatedLag::kTooSmall) return "conforms";
  return formatted("does not conform: drive_lag_s = %g of the profile is too small",
                   profile.drive_lag_s);
}

std::string now_utc() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%d %H:%M UTC", &utc);
  return text;
}

std::string system_name() {
  utsname name{};
  uname(&name);
  return std::string(name.sysname) + " " + name.release + " " + name.machine;
}

/// Nothing when there is no text.
void line(std::ostream& out, const char* name, const std::string& text) {
  if (!text.empty()) out << formatted("%-12s", name) << text << '\n';
}

std::string quantiles(const LatencyHistogram& histogram) {
  const auto us = [](int64_t ns) { return std::to_string(ns / 1000) + " us "; };
  // Above that, a quantile is not known.
  constexpr int64_t kLongest_ns = LatencyHistogram::kBins * LatencyHistogram::kBinWidth_ns;
  const auto at = [&](double q) {
    const int64_t ns = histogram.quantile_ns(q);
    return ns > kLongest_ns ? "more than " + us(kLongest_ns) : us(ns);
  };
  return at(0.5) + "median, " + at(0.99) + "99 %, " + us(histogram.max_ns()) + "at most";
}

std::string faults(const LinkHealth& health) {
  std::string text;
  for (size_t i = 1; i < kLinkFaults; ++i) {
    if (health.faults[i] == 0) continue;
    text += (text.empty() ? "" : ", ") + std::to_string(health.faults[i]) + " " +
            to_string(static_cast<LinkFault>(i));
  }
  return text.empty() ? "none" : text;
}

void print_identity(std::ostream& out, const Conformance& found, const std::string& version) {
  const BoardInfo& board = found.board;
  line(out, "date", now_utc());
  line(out, "program", "spidarctl " + version);
  line(out, "system", system_name());
  line(out, "device", board.device);
  line(out, "board", board.name);
  line(out, "opened as", found.seen.description);
  line(out, "usb id", board.usb_id);
  line(out, "path", board.path);
  line(out, "serial", board.serial);
  line(out, "evidence",
       to_string(board.trial) + (board.note.empty() ? std::string() : "; " + board.note));
  line(out, "profile",
       found.profile.name.empty() ? "none" : found.profile.name + ": " + found.profile.description);
}

void print_counters(std::ostream& out, const Conformance& found) {
  out << "  counter   smallest    largest  largest step\n";
  for (int i = 0; i < found.profile.geometry.count; ++i) {
    const auto k = static_cast<size_t>(i);
    out << formatted("  %7d%11d%11d%14lld\n", i, found.seen.smallest[k], found.seen.largest[k],
                     static_cast<long long>(found.seen.largest_step[k]));
  }
}

void print_answers(std::ostream& out, const Conformance& found) {
  const Observation& seen = found.seen;
  line(out, "period", quantiles(seen.period));
  line(out, "round trip", quantiles(seen.duration));
  if (!found.board.has_strings) return;
  line(out, "inputs", formatted("0x%04x, changed 0x%04x", seen.inputs, seen.changed_inputs));
  out << '\n';
  print_counters(out, found);
}

}  // namespace

bool Conformance::link_conforms() const noexcept {
  const uint64_t unanswered = seen.exchanges - seen.answered;
  return trouble.empty() && seen.answered > 0 && health.errors() == 0 &&
         1000 * unanswered <= seen.exchanges;
}

int Conformance::moved_counters() const noexcept {
  int moved = 0;
  for (size_t i = 0; i < static_cast<size_t>(profile.geometry.count); ++i)
    moved += seen.largest[i] != seen.smallest[i] ? 1 : 0;
  return moved;
}

const char* Conformance::verdict() const noexcept {
  if (conforms()) return "conforms";
  return link_conforms() && board.has_strings && moved_counters() == 0
             ? "no counter moved, so nothing was shown but that the board answers"
             : "does not conform";
}

bool Conformance::conforms() const noexcept {
  if (delay && delay->fault) return false;
  const bool lag_is_stated =
      !delay || !delay->measured() ||
      judge_lag(profile, *delay->fit, late_ticks()).stated != StatedLag::kTooSmall;
  const bool moved = !board.has_strings || moved_counters() == profile.geometry.count;
  return link_conforms() && moved && (!wiring || wiring->as_profile()) && lag_is_stated;
}

int Conformance::late_ticks() const noexcept {
  const int64_t beyond_ns = seen.duration.quantile_ns(0.99) - BoardDevice::kReplyWait_ns;
  return beyond_ns > 0 ? static_cast<int>((beyond_ns + kTick_ns - 1) / kTick_ns) : 0;
}

void print_conformance(std::ostream& out, const Conformance& found, const std::string& version) {
  const Observation& seen = found.seen;
  out << "SPIDAR conformance report\n\n";
  print_identity(out, found, version);
  out << '\n';
  line(out, "exchanges",
       std::to_string(seen.exchanges) + ", " + std::to_string(seen.answered) + " answered");
  line(out, "faults", faults(found.health));
  line(out, "ended by", found.trouble);
  if (seen.answered > 0) print_answers(out, found);
  out << '\n';
  if (found.wiring) {
    print_wiring(out, found.profile, found.answers, *found.wiring);
    out << '\n';
  }
  if (found.delay) {
    print_delay(out, found.profile, *found.delay, found.late_ticks());
    out << '\n';
  }
  line(out, "link", found.link_conforms() ? "conforms" : "does not conform");
  if (found.board.has_strings)
    line(out, "counters",
         std::to_string(found.moved_counters()) + " of " +
             std::to_string(found.profile.geometry.count) + " moved" +
             (found.moved_counters() < found.profile.geometry.count
                  ? "; nothing was shown of the rest"
                  : ""));
  line(out, "motors",
       !found.wiring                ? "not tried"
       : found.wiring->as_profile() ? "conform"
                                    : "do not conform");
  line(out, "lag",
       found.delay ? delay_summary(found.profile, *found.delay, found.late_ticks()) : "not tried");
  line(out, "verdict", found.verdict());
}

}  // namespace spidar
