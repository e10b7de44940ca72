// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The measured lag of the drives as text.
#pragma once

#include <iosfwd>
#include <string>

#include "spidar/conformance/delay_test.h"
#include "spidar/conformance/lag_verdict.h"

namespace spidar {

/// Lag, t_d, the line for the profile, and the stiffness that is safe; or why there is no number.
void print_delay(std::ostream& out, const Profile& profile, const DelayTest& test, int late_ticks);

/// In a word or two: "conforms", "does not conform: …", "not measured".
std::string delay_summary(const Profile& profile, const DelayTest& test, int late_ticks);

}  // namespace spidar
