// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <iosfwd>

#include "core/json_text.h"
#include "spidar/selftest/delay_test.h"
#include "spidar/selftest/wiring_report.h"

namespace spidar::selftest {

/// Prints, on standard error, what the hand must do before unclear motors are pulled again.
void print_hold_still(const WiringReport& report);

void print_wiring(std::ostream& out, const Profile& profile, const WiringAnswers& answers,
                  const WiringReport& report);
Json wiring_json(const Profile& profile, const WiringAnswers& answers, const WiringReport& report);

/// `verdict` is valid only if the test has a result.
void print_lag(std::ostream& out, const Profile& profile, const DelayTest& test,
               const LagVerdict& verdict);
Json lag_json(const DelayTest& test, const LagVerdict& verdict);

}  // namespace spidar::selftest
