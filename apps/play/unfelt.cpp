// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "apps/play/unfelt.h"

#include <algorithm>
#include <cstdio>
#include <utility>
#include <vector>

#include "core/analysis/no_force_reason.h"

namespace {

/// Reasons of less than this share of the frames are left out.
constexpr double kWorthALine = 0.005;

std::string sentence_of(const std::string& nick) {
  for (size_t i = 0; i < spidar::kNoForceReasons; ++i) {
    const auto limit = static_cast<spidar::NoForceReason>(i);
    if (nick == spidar::nick(limit)) return spidar::sentence(limit);
  }
  return nick;
}

std::string percent(double share) {
  char text[16];
  std::snprintf(text, sizeof(text), "%.1f %%", 100 * share);
  return text;
}

}  // namespace

std::string unfelt_text(const std::map<std::string, uint64_t>& frames, const std::string& last) {
  const std::string felt = spidar::nick(spidar::NoForceReason::kNone);
  double all = 0;
  double unfelt = 0;
  std::vector<std::pair<std::string, double>> reasons;
  for (const auto& [nick, count] : frames) {
    // The first frames are analysed before the pipeline plays and the device runs.
    if (nick == spidar::nick(spidar::NoForceReason::kNotPlaying) ||
        nick == spidar::nick(spidar::NoForceReason::kDeviceStarting)) {
      continue;
    }
    all += static_cast<double>(count);
    if (nick == felt) continue;
    unfelt += static_cast<double>(count);
    reasons.emplace_back(nick, static_cast<double>(count));
  }
  std::stable_sort(reasons.begin(), reasons.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  if (reasons.size() == 1 && unfelt == all) {
    return "Nothing was felt: " + sentence_of(reasons.front().first) + "\n";
  }
  std::string text;
  if (unfelt > kWorthALine * all) {
    text += "Nothing was felt in " + percent(unfelt / all) + " of the frames:\n";
    for (const auto& [nick, count] : reasons) {
      if (count >= kWorthALine * all)
        text += percent(count / all) + "  " + sentence_of(nick) + "\n";
    }
  }
  if (last != felt && !last.empty()) {
    text += "Nothing was felt in the last second: " + sentence_of(last) + "\n";
  }
  return text;
}
