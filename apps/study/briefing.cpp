// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "apps/study/briefing.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <optional>
#include <stdexcept>

#include "apps/study/answers.h"

namespace study {
namespace {

void append(const Briefing& briefing, const std::string& check, const std::string& answer) {
  append_line(briefing.record, "participant,check,answer,time_utc",
              briefing.participant + ',' + check + ',' + answer + ',' + utc_now());
}

struct Check {
  std::string name;  // in the record
  std::string text;
};

/// Nothing at the end of input.
std::optional<bool> ask_yes_or_no(const std::string& text, std::istream& in, std::ostream& out) {
  for (std::string line; out << text << " yes or no > " << std::flush, std::getline(in, line);) {
    if (line == "yes") return true;
    if (line == "no") return false;
  }
  return std::nullopt;
}

bool passes(const Briefing& briefing, const Check& check, std::istream& in, std::ostream& out) {
  const std::optional<bool> answer = ask_yes_or_no(check.text, in, out);
  if (!answer) return false;
  append(briefing, check.name, *answer ? "yes" : "no");
  if (!*answer) out << briefing.participant << " does not take part\n";
  return *answer;
}

/// Records whether there is a reason, but not which one, because it concerns the person's health.
bool is_eligible(const Briefing& briefing, std::istream& in, std::ostream& out) {
  bool eligible = true;
  for (const std::string& reason : exclusions()) {
    const std::optional<bool> answer = ask_yes_or_no(reason, in, out);
    if (!answer) return false;
    eligible = eligible && !*answer;
  }
  append(briefing, "eligible", eligible ? "yes" : "no");
  if (!eligible) out << briefing.participant << " does not take part\n";
  return eligible;
}

bool stop_works(const Briefing& briefing, std::istream& in, std::ostream& out) {
  if (!briefing.while_taut) return true;
  bool works = false;
  briefing.while_taut([&] {
    works =
        passes(briefing,
               {"emergency-stop",
                "The strings are taut, and nobody holds the grip. Press the emergency stop. Did "
                "all strings become slack at once?"},
               in, out);
  });
  if (!works) return false;
  return passes(
      briefing,
      {"stop-in-reach",
       "Switch the motors on again. Can the participant reach the stop with the hand that "
       "does not hold the grip, and have they pressed it once?"},
      in, out);
}

bool force_confirmed(const Briefing& briefing, std::istream& in, std::ostream& out) {
  if (briefing.force_N <= kGentle_N) return true;
  char sentence[64];
  std::snprintf(sentence, sizeof sentence, "I am responsible for %g N", briefing.force_N);
  out << "More than " << kGentle_N << " N is asked for. Type, with your name: " << sentence
      << " NAME > " << std::flush;
  std::string line;
  const std::string begin = std::string(sentence) + " ";
  if (!std::getline(in, line)) return false;
  if (line.compare(0, begin.size(), begin) != 0 || line.size() == begin.size()) {
    out << "not confirmed; without max-force the limit is " << kGentle_N << " N\n";
    return false;
  }
  check_name(line);
  append(briefing, "force", line);
  return true;
}

}  // namespace

std::vector<std::string> exclusions() {
  return {
      "Is the participant younger than 18?",
      "Does the participant have an electronic implant, such as a pacemaker, a defibrillator or an "
      "insulin pump?",
      "Has the participant ever had an epileptic seizure?",
      "Does the participant have an injury, a wound, an inflammation or numbness of the hand, the "
      "arm or the shoulder, or white fingers in the cold?",
      "Is the participant pregnant?",
      "Is the participant tired, ill, or under the influence of alcohol or drugs?",
  };
}

bool brief(const Briefing& briefing, std::istream& in, std::ostream& out) {
  check_name(briefing.participant);
  const Check consent{"consent", "Has the participant read and signed the consent form?"};
  const Check loose{"loose-things",
                    "Are rings, watches and bracelets taken off, sleeves rolled up, and hair and "
                    "scarf tied back?"};
  return passes(briefing, consent, in, out) && is_eligible(briefing, in, out) &&
         passes(briefing, loose, in, out) && force_confirmed(briefing, in, out) &&
         stop_works(briefing, in, out);
}

}  // namespace study
