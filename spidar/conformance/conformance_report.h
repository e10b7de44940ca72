// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What `spidarctl selftest` and `conformance` found: for people, for programs, and to send in.
#pragma once

#include <iosfwd>
#include <optional>
#include <string>

#include "spidar/conformance/delay_test.h"
#include "spidar/conformance/observed_device.h"
#include "spidar/conformance/report_text.h"
#include "spidar/conformance/wiring_report.h"
#include "spidar/session/board_list.h"

namespace spidar {

/// On standard error: what to do with the hand before unclear motors are pulled again.
void tell_to_hold_still(const WiringReport& report);

void print_wiring(std::ostream& out, const Profile& profile, const WiringAnswers& answers,
                  const WiringReport& report);
Json wiring_json(const Profile& profile, const WiringAnswers& answers, const WiringReport& report);

struct Conformance {
  BoardInfo board;
  const Profile& profile;
  const Observation& seen;
  LinkHealth health;
  WiringAnswers answers;
  std::optional<WiringReport> wiring;  ///< none: no string was pulled
  std::optional<DelayTest> delay;      ///< none: not tried
  std::string trouble;                 ///< why it ended before its end; may be empty

  /// Of a thousand exchanges one may have had no answer in time, as the host's scheduling has it;
  /// nothing else may go wrong.
  bool link_conforms() const noexcept;
  /// By which the slowest hundredth of the answers would be late while playing, see judge_lag().
  int late_ticks() const noexcept;
  /// How many counters had more than one value.
  int moved_counters() const noexcept;
  /// All is as it should be, as far as it was tried, and every counter of a board with strings has
  /// moved: one that did not shows nothing.
  bool conforms() const noexcept;
  /// "conforms", "does not conform", or that nothing was shown.
  const char* verdict() const noexcept;
};

/// `version`: of the program that writes it.
void print_conformance(std::ostream& out, const Conformance& found, const std::string& version);

}  // namespace spidar
