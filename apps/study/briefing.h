// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What is asked before a participant may hold the grip.
#pragma once

#include <functional>
#include <istream>
#include <ostream>
#include <string>
#include <vector>

namespace study {

/// The limit of the force unless the experimenter confirms more.
constexpr double kGentle_N = 1;

/// Questions whose answer must be no.
std::vector<std::string> exclusions();

struct Briefing {
  std::string record;  ///< file to which every answer is appended: participant,check,answer,time
  std::string participant;
  double force_N = kGentle_N;  ///< the largest force of the trials
  /// Tightens the strings while it runs its argument; empty if nothing pulls: a simulated device.
  std::function<void(const std::function<void()>&)> while_taut;
};

/// Asks the experimenter for the participant's consent and for every reason to exclude them, has
/// the emergency stop tested, and has more than kGentle_N confirmed by a typed sentence. Every
/// answer is on the disk before the next question. Returns false, after saying why, if the
/// participant may not take part, or at the end of input. Throws std::runtime_error when the record
/// cannot be written.
bool brief(const Briefing& briefing, std::istream& in, std::ostream& out);

}  // namespace study
