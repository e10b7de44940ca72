// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Prints the result of `spidarctl calibrate`.
#pragma once

#include <iosfwd>
#include <string>

#include "spidar/calibration/calibration.h"
#include "spidar/conformance/report_text.h"
#include "spidar/profiles/profile.h"

namespace spidar {

/// `how` is a phrase like "moved for 20 s".
void print_result(std::ostream& out, const Profile& profile, const CalibrationResult& result,
                  const std::string& how);

/// Infinities are null.
Json result_json(const Profile& profile, const CalibrationResult& result, const std::string& how);

}  // namespace spidar
